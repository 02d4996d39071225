#include "ground/open_loop.hpp"

#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "plant/model/airframe.hpp"
#include "plant/model/propulsion.hpp"
#include "services/runtime/config_error.hpp"
#include "services/runtime/vehicle_file.hpp"

namespace swiftlet::ground {
namespace {

plant::Vehicle kaylion() {
  return runtime::load_vehicle(SWIFTLET_SOURCE_DIR "/config/vehicles/kaylion.yaml");
}

std::vector<PulseWidths> pulses(const std::string& rows) {
  return read_pulses(runtime::parse_csv("t,pwm1,pwm2,pwm3,pwm4\n" + rows, "pwm.csv", pulse_columns(4), 2),
                     kaylion());
}

plant::VehicleState state(const std::string& rows) {
  return read_state(runtime::parse_csv("px,py,pz,vx,vy,vz,qw,qx,qy,qz,p,q,r,om1,om2,om3,om4\n" + rows,
                                       "start.csv", state_columns(4)),
                    4);
}

std::string fault_of(const std::function<void()>& read) {
  try {
    read();
  } catch (const runtime::ConfigError& error) {
    return error.what();
  }
  return "none";
}

TEST(OpenLoop, ARowForEachMillisecondFromTheFirstTimeToTheLast) {
  const auto rows =
      simulate_open_loop(kaylion(), 3.7, {}, pulses("0.5,1400,1400,1400,1400\n0.6005,1400,1400,1400,1400\n"));
  ASSERT_EQ(rows.size(), 101u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].time_ns, 500'000'000 + static_cast<std::int64_t>(i) * 1'000'000);
  }
}

TEST(OpenLoop, HoversAtTheSpeedAndPulseWidthOfTheAnchors) {
  const plant::Vehicle vehicle = kaylion();
  const double throttle = plant::throttle_from_steady_thrust(vehicle, 3.7, plant::hover_thrust(vehicle));
  const double pulse = 1039.0 + 1000.0 * throttle;
  plant::VehicleState initial;
  initial.rotor_speeds.fill(plant::hover_speed(vehicle));
  std::string row = "," + runtime::exact(pulse);
  row = row + row + row + row + "\n";
  const auto rows = simulate_open_loop(vehicle, 3.7, initial, pulses("0" + row + "2" + row));
  EXPECT_LT(rows.back().state.position_ned.norm(), 1e-9);
}

TEST(OpenLoop, AThrottleChangesAtItsTimeAlsoBetweenMilliseconds) {
  const plant::Vehicle vehicle = kaylion();
  const auto rows = simulate_open_loop(
      vehicle, 4.0, {},
      pulses("0,1039,1039,1039,1039\n0.0105,2039,1039,1039,1039\n0.02,1039,1039,1039,1039\n"));
  // One first-order lag after the other, Eq. (18).
  const auto rise = [&](double from, double throttle, double t) {
    const double steady = plant::steady_speed_from_throttle(vehicle, 4.0, throttle);
    return steady + (from - steady) * std::exp(-t / vehicle.motor.time_constant_s);
  };
  const double before = rise(0.0, 0.0, 0.0105);
  EXPECT_NEAR(rows[10].state.rotor_speeds[0], rise(0.0, 0.0, 0.010), 1e-8);
  EXPECT_NEAR(rows[20].state.rotor_speeds[0], rise(before, 1.0, 0.0095), 1e-8);
  EXPECT_NEAR(rows[20].state.rotor_speeds[1], rise(before, 0.0, 0.0095), 1e-8);
}

TEST(OpenLoop, TakesTheInitialStateAsItIs) {
  const plant::VehicleState start = state("1,2,-3,0.1,0.2,0.3,0.5,0.5,0.5,0.5,1,2,3,100,200,300,400\n");
  EXPECT_EQ(start.position_ned, Eigen::Vector3d(1, 2, -3));
  EXPECT_EQ(start.velocity_ned, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(start.q_ned_from_frd.y(), 0.5);
  EXPECT_EQ(start.body_rates_frd, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(start.rotor_speeds[3], 400.0);
  EXPECT_EQ(start.rotor_speeds[4], 0.0);
}

TEST(OpenLoop, RefusesBadInputWithFileLineColumnValueAndLimit) {
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << " lacks " << part;
  };
  const std::string low = fault_of([] { pulses("0,1039,1039,1039,1039\n1,1038,1039,1039,1039\n"); });
  has(low, "pwm.csv:3");
  has(low, "pwm1");
  has(low, "1038");
  has(low, "1039");
  has(low, "2039");
  has(fault_of([] { pulses("0,1039,1039,1039,2040\n1,1039,1039,1039,1039\n"); }), "pwm4");
  has(fault_of([] { pulses("0,1039,1039,1039,1039\n0,1039,1039,1039,1039\n"); }), "above the row before");
  has(fault_of([] { pulses("0,1039,1039,1039,1039\n"); }), "at least 2");
  has(fault_of([] { pulses("0,1039,nan,1039,1039\n1,1039,1039,1039,1039\n"); }), "finite number");
  has(fault_of([] { pulses("0,1039,1039,1039\n1,1039,1039,1039,1039\n"); }), "4 fields");
  has(fault_of([] { state("0,0,0,0,0,0,1.1,0,0,0,0,0,0,0,0,0,0\n"); }), "length 1.1");
  has(fault_of([] { state("0,0,0,0,0,0,1,0,0,0,0,0,0,0,-1,0,0\n"); }), "om2");
  has(fault_of([] { state("0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0\n0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0\n"); }),
      "second row");
}

}  // namespace
}  // namespace swiftlet::ground
