// Tracking error of the default controller on the square, in the default world and with disturbances.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/simulation/simulated_flight.hpp"
#include "tests/support/campaign.hpp"
#include "tests/support/flight_setup.hpp"

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
  double takeoff_peak_m = 0.0;
  double peak_m = 0.0;
  double rms_m = 0.0;             // from take-off to the start of the landing
  double lowest_voltage_v = 1e9;  // of the battery, over the whole flight
};

struct FlightSetup : tests::FlightSetup {
  Flight fly(const std::string& speed, std::uint64_t seed) const {
    ClosedLoop loop(flown, nominal, simulation, control, seed);
    const control::Mission mission = square(speed, control.limits);
    Flight flight;
    double sum = 0.0;
    int count = 0;
    const auto watch = [&] {
      const control::Status& status = loop.controller.status();
      flight.lowest_voltage_v = std::min(flight.lowest_voltage_v, loop.plant.truth().supply_voltage_v);
      const bool landing = status.mission.item_index + 1 == status.mission.item_count;
      if (status.mission.state != control::MissionState::kRunning || landing) return false;
      const double error_m = loop.tracking_error().norm();
      flight.peak_m = std::max(flight.peak_m, error_m);
      if (status.mission.item_index == 0) flight.takeoff_peak_m = flight.peak_m;
      sum += error_m * error_m;
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
  setup.simulation.air.wind_ned = {1.6, -1.2, 0.0};
  setup.simulation.air.gust_sigma_ned = {0.7, 0.7, 0.3};
  setup.flown.battery.capacity_ah *= 0.06;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Flight flight = setup.fly("0.5", seed);
    EXPECT_LT(flight.rms_m, 20e-3);
    EXPECT_LT(flight.lowest_voltage_v, 3.6);
  }
  setup.control.disturbance.bandwidth = 0.0;
  EXPECT_GT(setup.fly("0.5", 1).rms_m, 1.5 * 20e-3) << "without the disturbance observer";
}

// GIVEN a mass that the controller does not know WHEN the vehicle takes off THEN it learns the lift as it leaves the ground.
TEST(DisturbedFlight, LearnsTheMassAtTakeOff) {
  for (const double factor : {0.9, 1.0, 1.1, 1.2}) {
    FlightSetup setup;
    setup.flown.mass_kg *= factor;
    const Flight flight = setup.fly("0.5", 1);
    EXPECT_LT(flight.takeoff_peak_m, 6e-3) << factor;
    EXPECT_LT(flight.rms_m, 1.05e-3) << factor;
    setup.control.rough_air.learn_lift = false;
    if (factor == 1.0) continue;
    EXPECT_GT(setup.fly("0.5", 1).takeoff_peak_m, 40e-3) << factor << " without learning";
  }
}

// GIVEN 10 % more mass and Dryden gusts of 0.5 m/s in a wind of 2.2 m/s THEN the error stays within 8 mm RMS, 30 mm peak.
TEST(DisturbedFlight, TracksTheSquareHeavyInDrydenGusts) {
  const int flights = tests::draws(4, 200);
  for (int seed = 1; seed <= flights; ++seed) {
    FlightSetup setup;
    setup.flown.mass_kg *= 1.1;
    setup.flown.linear_drag = 0.01;
    setup.simulation.air.wind_ned = {2.2 * std::cos(seed), 2.2 * std::sin(seed), 0.0};
    setup.simulation.air.gust_sigma_ned = {0.5, 0.5, 0.5};
    setup.simulation.air.dryden = {1.0, 2.2};
    const Flight flight = setup.fly("0.5", static_cast<std::uint64_t>(seed));
    EXPECT_LT(flight.rms_m, 8e-3) << seed;
    EXPECT_LT(flight.peak_m, 30e-3) << seed;
  }
}

// GIVEN rotors in ground effect THEN modelling it takes most of its error away.
TEST(DisturbedFlight, KnowsTheGroundEffect) {
  FlightSetup setup;
  setup.simulation.ground.effect_rotor_radius_m = 0.03;
  const double unknown_m = setup.fly("0.5", 1).takeoff_peak_m;
  setup.control.rough_air.rotor_radius_m = 0.03;
  const double known_m = setup.fly("0.5", 1).takeoff_peak_m;
  EXPECT_LT(unknown_m, 10e-3);
  EXPECT_LT(known_m, unknown_m);
}

}  // namespace
}  // namespace swiftlet::ground
