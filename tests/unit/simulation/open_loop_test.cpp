#include "swiftlet/simulation/open_loop.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/propulsion.hpp"
#include "tests/unit/plant/model/vehicles.hpp"
#include "tests/unit/plant/simulation/paper_equations.hpp"

namespace swiftlet::simulation::open_loop_test {

using tests::kaylion;

std::vector<PulseWidths> pulses(const std::string& rows) {
  return read_pulses(io::parse_csv("t,pwm1,pwm2,pwm3,pwm4\n" + rows, "pwm.csv", pulse_columns(4), 2),
                     kaylion());
}

plant::VehicleState state(const std::string& rows) {
  return read_state(io::parse_csv("px,py,pz,vx,vy,vz,qw,qx,qy,qz,p,q,r,om1,om2,om3,om4\n" + rows, "start.csv",
                                  state_columns(4)),
                    4);
}

std::string fault_of(const std::function<void()>& read) {
  try {
    read();
  } catch (const io::ConfigError& error) {
    return error.what();
  }
  return "none";
}

TEST(OpenLoop, ReturnsARowEachMillisecondFromFirstToLastTime) {
  const auto rows =
      simulate_open_loop(kaylion(), 3.7, {}, pulses("0.5,1400,1400,1400,1400\n0.6005,1400,1400,1400,1400\n"));
  ASSERT_EQ(rows.size(), 101u);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].time_ns, 500'000'000 + static_cast<std::int64_t>(i) * 1'000'000);
  }
}

TEST(OpenLoop, HoversAtTheAnchorSpeedAndPulseWidth) {
  const plant::Vehicle& vehicle = kaylion();
  const double throttle = plant::throttle_from_steady_thrust(vehicle, 3.7, plant::hover_thrust(vehicle));
  const double pulse = 1039.0 + 1000.0 * throttle;
  plant::VehicleState initial;
  initial.rotor_speeds.fill(plant::hover_speed(vehicle));
  std::string row = "," + io::exact(pulse);
  row = row + row + row + row + "\n";
  const auto rows = simulate_open_loop(vehicle, 3.7, initial, pulses("0" + row + "2" + row));
  EXPECT_LT(rows.back().state.position_ned.norm(), 1e-9);
}

TEST(OpenLoop, AppliesThrottleChangesBetweenMilliseconds) {
  const plant::Vehicle& vehicle = kaylion();
  const auto rows = simulate_open_loop(
      vehicle, 4.0, {},
      pulses("0,1039,1039,1039,1039\n0.0105,2039,1039,1039,1039\n0.02,1039,1039,1039,1039\n"));
  // Consecutive first-order lags, Eq. (18).
  const auto rise = [&](double from, double throttle, double t) {
    const double steady = plant::steady_speed_from_throttle(vehicle, 4.0, throttle);
    return steady + (from - steady) * std::exp(-t / vehicle.motor.time_constant_s);
  };
  const double before = rise(0.0, 0.0, 0.0105);
  EXPECT_NEAR(rows[10].state.rotor_speeds[0], rise(0.0, 0.0, 0.010), 1e-8);
  EXPECT_NEAR(rows[20].state.rotor_speeds[0], rise(before, 1.0, 0.0095), 1e-8);
  EXPECT_NEAR(rows[20].state.rotor_speeds[1], rise(before, 0.0, 0.0095), 1e-8);
}

// Simulates 2 s with pulse widths that change at any nanosecond, and compares each row with an independent
// integration of the paper's equations. The tolerance is relative to the peak of each quantity.
void expect_paper_motion(const plant::VehicleState& initial, const std::vector<PulseWidths>& commands,
                         double tolerance) {
  constexpr double kSupply = 3.9;
  const std::vector<MotionRow> rows = simulate_open_loop(kaylion(), kSupply, initial, commands);
  ASSERT_EQ(rows.size(), 2001u);

  tests::paper::Equations equations{kaylion().inertia, tests::paper::Motor::kReduced, kSupply, true};
  tests::paper::State reference = tests::paper::state_of(initial);
  tests::paper::Comparison comparison;
  std::size_t held = 0;
  std::int64_t now_ns = 0;
  for (std::size_t row = 1; row < rows.size(); ++row) {
    while (now_ns < rows[row].time_ns) {
      std::copy_n(commands[held].throttle.begin(), 4, equations.throttle.begin());
      const std::int64_t until_ns = std::min(rows[row].time_ns, commands[held + 1].time_ns);
      tests::paper::integrate(equations, reference, static_cast<double>(now_ns) * 1e-9,
                              static_cast<double>(until_ns) * 1e-9);
      now_ns = until_ns;
      if (now_ns == commands[held + 1].time_ns) ++held;
    }
    comparison.add(reference, tests::paper::state_of(rows[row].state));
  }
  for (std::size_t i = 0; i < tests::paper::kNames.size(); ++i) {
    // A quantity that stays near 0 by symmetry has an absolute tolerance.
    EXPECT_LT(comparison.worst[i], tolerance * std::max(comparison.peak[i], 1e-3))
        << tests::paper::kNames[i] << " reaches " << comparison.peak[i];
  }
}

TEST(OpenLoop, TumblingMatchesThePaperEquations) {
  tests::UniformRandom draw;
  for (int flight = 0; flight < 5; ++flight) {
    SCOPED_TRACE("flight " + std::to_string(flight));
    plant::VehicleState initial;
    initial.velocity_ned = {draw(-3, 3), draw(-3, 3), draw(-3, 3)};
    initial.q_ned_from_frd =
        Eigen::Quaterniond(draw(-1, 1), draw(-1, 1), draw(-1, 1), draw(-1, 1)).normalized();
    initial.body_rates_frd = {draw(-15, 15), draw(-15, 15), draw(-15, 15)};
    for (std::size_t i = 0; i < 4; ++i) initial.rotor_speeds[i] = draw(0, 2300);
    std::vector<PulseWidths> commands;
    for (std::int64_t at_ns = 0; at_ns < 2'000'000'000; at_ns += static_cast<std::int64_t>(draw(1e5, 8e7))) {
      PulseWidths pulse{at_ns, {}};
      for (std::size_t i = 0; i < 4; ++i) pulse.throttle[i] = draw(0, 1);
      commands.push_back(pulse);
    }
    commands.push_back({2'000'000'000, {}});
    expect_paper_motion(initial, commands, 1e-7);
  }
}

// Both left rotors at full throttle, the right ones at zero, for 2 s.
TEST(OpenLoop, FastestTumbleMatchesThePaperEquations) {
  PulseWidths roll;
  roll.throttle = {0.0, 1.0, 1.0, 0.0};
  expect_paper_motion({}, {roll, {2'000'000'000, {}}}, 1e-6);
}

TEST(OpenLoop, ThrowsBeyondTheBodyRateLimit) {
  plant::VehicleState fast;
  fast.body_rates_frd.x() = 9990.0;  // of 10,000
  const auto commands = pulses("0,1039,2039,2039,1039\n1,1039,2039,2039,1039\n");
  EXPECT_THROW(simulate_open_loop(kaylion(), 4.0, fast, commands), std::runtime_error);
  const auto coasting = pulses("0,1039,1039,1039,1039\n0.01,1039,1039,1039,1039\n");
  EXPECT_NO_THROW(simulate_open_loop(kaylion(), 4.0, fast, coasting));
}

TEST(OpenLoop, ReadsTheInitialState) {
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

}  // namespace swiftlet::simulation::open_loop_test
