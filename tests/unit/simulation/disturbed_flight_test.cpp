// Tracking error of the default controller on the square, in the default world and with disturbances.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/simulated_flight.hpp"

namespace swiftlet::ground {
namespace {

control::Mission square(const std::string& speed, const control::Limits& limits) {
  const std::string waypoint = ", speed_m_s: " + speed + "}\n";
  control::Mission mission =
      parse_mission_file(
          "name: square\nframe: ned\ntolerance_m: 0.2\nitems:\n"
          "  - {kind: takeoff, height_m: 1.0, speed_m_s: 0.5, hold_s: 0.5}\n"
          "  - {kind: waypoint, position_m: [2, 0, -1]" +
              waypoint + "  - {kind: waypoint, position_m: [2, 2, -1]" + waypoint +
              "  - {kind: waypoint, position_m: [0, 2, -1]" + waypoint +
              "  - {kind: waypoint, position_m: [0, 0, -1]" + waypoint + "  - {kind: land, speed_m_s: 0.5}\n",
          "square.yaml", limits)
          .mission;
  mission.id = 1;
  return mission;
}

struct Flight {
  double rms_m = 0.0;             // from take-off to the start of the landing
  double lowest_voltage_v = 1e9;  // of the battery, over the whole flight
};

struct FlightSetup {
  plant::Vehicle nominal = runtime::load_vehicle(runtime::find_config("vehicles/kaylion.yaml"));
  plant::Vehicle flown = nominal;
  plant::SimulationSettings world =
      runtime::load_simulation_settings(runtime::find_config("simulation/default.yaml"));
  control::ControlSettings control =
      runtime::load_control_settings(runtime::find_config("control/motor_lag.yaml"));

  Flight fly(const std::string& speed, std::uint64_t seed) const {
    ClosedLoop loop(flown, nominal, world, control, seed);
    const control::Mission mission = square(speed, control.limits);
    Flight flight;
    double sum = 0.0;
    int count = 0;
    const auto watch = [&] {
      const control::Status& status = loop.controller.status();
      flight.lowest_voltage_v = std::min(flight.lowest_voltage_v, loop.plant.truth().supply_voltage_v);
      const bool landing = status.mission.item_index + 1 == status.mission.item_count;
      if (status.mission.state != control::MissionState::kRunning || landing) return false;
      sum += loop.tracking_error().squaredNorm();
      ++count;
      return false;
    };
    const SimulatedFlight done =
        ground::fly(loop, mission, planned_duration_s(mission, control.limits), {nullptr, nullptr, watch});
    EXPECT_TRUE(done.completed) << done.reason;
    flight.rms_m = std::sqrt(sum / count);
    return flight;
  }
};

TEST(DisturbedFlight, TracksTheSquareAtHalfAMetrePerSecond) {
  const FlightSetup setup;
  for (const std::uint64_t seed : {1, 2, 3}) EXPECT_LT(setup.fly("0.5", seed).rms_m, 5e-3);
}

TEST(DisturbedFlight, TracksTheSquareAtOneAndAHalfMetresPerSecond) {
  FlightSetup setup;
  for (const std::uint64_t seed : {1, 2, 3}) EXPECT_LT(setup.fly("1.5", seed).rms_m, 25e-3);
}

// 10 % more mass than the controller's model, 2 m/s of wind with gusts, and a full cell that is nearly empty
// at the end.
TEST(DisturbedFlight, TracksTheSquareHeavyInWindOnADrainingBattery) {
  FlightSetup setup;
  setup.flown.mass_kg *= 1.1;
  setup.flown.linear_drag = 0.01;
  setup.world.air.wind_ned = {1.6, -1.2, 0.0};
  setup.world.air.gust_sigma_ned = {0.7, 0.7, 0.3};
  setup.flown.battery.capacity_ah *= 0.06;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Flight flight = setup.fly("0.5", seed);
    EXPECT_LT(flight.rms_m, 20e-3);
    EXPECT_LT(flight.lowest_voltage_v, 3.6);
  }
  setup.control.disturbance.bandwidth = 0.0;
  EXPECT_GT(setup.fly("0.5", 1).rms_m, 1.5 * 20e-3) << "without the disturbance observer";
}

}  // namespace
}  // namespace swiftlet::ground
