#include "swiftlet/control/design/level_loops.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/control/design/control_gains.hpp"
#include "swiftlet/control/design/flown_delay.hpp"
#include "swiftlet/control/design/margins.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::control::level_loops_test {

using plant::ControlLevel;

constexpr double kLag_s = 0.05;

// Without derivative.
VehicleLoops plain_loops() {
  VehicleLoops loops;
  loops.rate_p.setConstant(10.0);
  loops.rate_i.setConstant(2.0);
  loops.derivative_cutoff = 300.0;
  loops.attitude_p.setConstant(2.0);
  loops.position_p = 0.5;
  loops.velocity_p = 1.0;
  return loops;
}

ControlGains gains() {
  const plant::Vehicle vehicle = io::load_vehicle(tests::in_source("config/vehicles/crazyflie2.yaml"));
  const ControlSettings settings =
      io::load_control_settings(tests::in_source("config/control/motor_lag.yaml"));
  return control_gains(design(vehicle, settings), settings);
}

double slowest_pole(const Loop& loop) {
  double real = -1e9;
  for (const auto& pole : closed_loop_poles(loop)) real = std::max(real, pole.real());
  return real;
}

// rate = C / (s (lag s + 1) + C) command with C = p + i / s, and the attitude loop is P over s of it.
TEST(LevelLoops, AttitudeIsTheTransferFunctionOnPaper) {
  const auto loops = level_loops(ControlLevel::kAttitude, gains(), {kLag_s, 112.0}, plain_loops(), 0.03);
  for (const double omega : {0.5, 2.0, 5.0, 12.0}) {
    const std::complex<double> s(0.0, omega);
    const std::complex<double> c = 10.0 + 2.0 / s;
    const std::complex<double> expected = 2.0 / s * c / (s * (kLag_s * s + 1.0) + c);
    EXPECT_LT(std::abs(frequency_response(loops[0].loop, omega) - expected), 1e-9) << omega;
  }
}

// At level rates the delay is in the loop of the attitude, at level attitude it is not.
TEST(LevelLoops, TheDelayIsInTheLoopsThatControlCloses) {
  constexpr double kDelay_s = 0.03;
  for (const ControlLevel level :
       {ControlLevel::kRates, ControlLevel::kAttitude, ControlLevel::kTrajectory}) {
    const auto without = level_loops(level, gains(), {kLag_s, 112.0}, plain_loops(), 0.0);
    const auto with = level_loops(level, gains(), {kLag_s, 112.0}, plain_loops(), kDelay_s);
    for (std::size_t i = 0; i < 5; ++i) {  // the vertical one has an observer before the delay
      const double omega = 3.0;
      std::complex<double> expected = frequency_response(without[i].loop, omega);
      const bool attitude_loop_has_delay = level == ControlLevel::kRates && i < 3;
      const bool outer_of_attitude = level == ControlLevel::kAttitude && i >= 3;
      if (level == ControlLevel::kRates && i >= 3) continue;  // the delay is inside the inner loop
      if (attitude_loop_has_delay || outer_of_attitude)
        expected *= std::exp(std::complex<double>(0.0, -omega * kDelay_s));
      EXPECT_LT(std::abs(frequency_response(with[i].loop, omega) - expected), 1e-6)
          << plant::to_string(level) << ' ' << kFlownLoopNames[i];
    }
  }
}

TEST(LevelLoops, ToleratedDelayIsTheBorderOfStability) {
  for (const ControlLevel level : {ControlLevel::kRates, ControlLevel::kAttitude}) {
    const auto loops_at = [&](double delay_s) {
      return level_loops(level, gains(), {kLag_s, 112.0}, plain_loops(), delay_s);
    };
    const std::array<double, 6> margins_s = delay_margins(loops_at);
    for (std::size_t i = 0; i < margins_s.size(); ++i) {
      if (!closed_by_control(level, i)) {
        EXPECT_TRUE(std::isinf(margins_s[i]));
        continue;
      }
      if (std::isinf(margins_s[i]) || margins_s[i] == 0.0) continue;
      EXPECT_LT(slowest_pole(loops_at(margins_s[i] - 1e-4)[i].loop), 0.0);
      EXPECT_GT(slowest_pole(loops_at(margins_s[i] + 1e-4)[i].loop), 0.0);
    }
    EXPECT_LT(*std::min_element(margins_s.begin(), margins_s.end()), kLongestDelay_s);
  }
}

TEST(LevelLoops, OfTheVehicleFollowItsPosition) {
  const auto loops = level_loops(ControlLevel::kTrajectory, gains(), {kLag_s, 112.0}, plain_loops(), 0.1);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    EXPECT_FALSE(closed_by_control(ControlLevel::kTrajectory, i));
    EXPECT_LT(slowest_pole(loops[i].loop), 0.0) << kFlownLoopNames[i];
    EXPECT_NEAR(step_response(loops[i], 10.0, 4).back(), 1.0, 1e-3) << kFlownLoopNames[i];
  }
}

}  // namespace swiftlet::control::level_loops_test
