#include "swiftlet/control/estimation/takeoff_consistency.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control::takeoff_consistency_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStep_s = 0.002;
const Vector3d kBias(0.1, -0.2, 0.3);  // m/s^2

struct Climbed {
  bool contradicted = false;
  double height_m = 0.0;  // at the contradiction, or at the end
};

// Climbs to 1 m along a cosine, tilted. The pose shows pose_fraction of the height.
Climbed climb(TakeoffConsistencyMonitor& monitor, double duration_s, double pose_fraction,
              const Vector3d& error_frd = Vector3d::Zero(), double start_z_ned = 0.0) {
  const Quaterniond tilted(Eigen::AngleAxisd(0.2, Vector3d::UnitX()));
  const double omega = M_PI / duration_s;
  Climbed out;
  for (double t = 0.0; t < duration_s && !out.contradicted; t += kStep_s) {
    out.height_m = 0.5 * (1.0 - std::cos(omega * t));
    const double upward = 0.5 * omega * omega * std::cos(omega * t);
    const Vector3d force_ned(0.0, 0.0, -upward - plant::kGravity);
    monitor.step(kStep_s, tilted.conjugate() * force_ned + kBias + error_frd, tilted,
                 start_z_ned - pose_fraction * out.height_m);
    out.contradicted = monitor.contradicted();
  }
  return out;
}

class TakeoffClimb : public testing::TestWithParam<double> {
 protected:
  TakeoffClimb() { monitor_.begin(kBias, 0.0); }
  TakeoffConsistencyMonitor monitor_;
};

TEST_P(TakeoffClimb, ShownByThePoseIsNotContradicted) {
  EXPECT_FALSE(climb(monitor_, GetParam(), 1.0).contradicted);
}

TEST_P(TakeoffClimb, ShownByThePoseToleratesASmallBias) {
  for (const double bias : {-0.15, 0.15}) {
    monitor_.begin(kBias, 0.0);
    EXPECT_FALSE(climb(monitor_, GetParam(), 1.0, {0.0, 0.0, bias}).contradicted) << bias;
  }
}

TEST_P(TakeoffClimb, NotShownByThePoseIsContradictedAtLowHeight) {
  const Climbed out = climb(monitor_, GetParam(), 0.0);
  EXPECT_TRUE(out.contradicted);
  EXPECT_LT(out.height_m, 0.25);
}

TEST_P(TakeoffClimb, IsNotMonitoredBeforeBegin) {
  TakeoffConsistencyMonitor idle;
  EXPECT_FALSE(climb(idle, GetParam(), 0.0).contradicted);
}

TEST_P(TakeoffClimb, IsMeasuredFromWhereTheVehicleStood) {
  monitor_.begin(kBias, -1.0);
  EXPECT_TRUE(climb(monitor_, GetParam(), 0.0, Vector3d::Zero(), -1.0).contradicted);
  monitor_.begin(kBias, -1.0);
  EXPECT_FALSE(climb(monitor_, GetParam(), 1.0, Vector3d::Zero(), -1.0).contradicted);
}

INSTANTIATE_TEST_SUITE_P(Seconds, TakeoffClimb, testing::Values(1.0, 1.5, 2.5), [](const auto& param) {
  return std::to_string(static_cast<int>(param.param * 10)) + "Tenths";
});

// GIVEN samples at 100 Hz, some of which are followed by another after 1 us, as after a step of PX4's clock, when a
// pose has corrected the estimate by 1 mm THEN the height is not taken for a jump of the speed.
TEST(TakeoffConsistencyMonitor, StandsSamplesThatFollowEachOtherAtOnce) {
  TakeoffConsistencyMonitor monitor;
  monitor.begin(Vector3d::Zero(), 0.0);
  const double omega = M_PI / 2.0;
  for (int i = 0; i < 200; ++i) {
    const double phase = omega * 0.01 * i;
    const double height_m = 0.5 * (1.0 - std::cos(phase));
    const Vector3d force(0.0, 0.0, -0.5 * omega * omega * std::cos(phase) - plant::kGravity);
    monitor.step(0.01, force, Quaterniond::Identity(), -height_m);
    EXPECT_FALSE(monitor.contradicted()) << i;
    if (i % 10 != 5) continue;
    monitor.step(1e-6, force, Quaterniond::Identity(), -height_m - 0.001);
    EXPECT_FALSE(monitor.contradicted()) << i;
  }
}

TEST(TakeoffConsistencyMonitor, IgnoresAVehicleAtRest) {
  TakeoffConsistencyMonitor monitor;
  monitor.begin(kBias, 0.0);
  for (int i = 0; i < 3000; ++i) {
    monitor.step(kStep_s, kBias + Vector3d(0.0, 0.0, -plant::kGravity - 0.15), Quaterniond::Identity(), 0.0);
    ASSERT_FALSE(monitor.contradicted()) << i;
  }
}

TEST(TakeoffConsistencyMonitor, EndsOnceThePoseShowsTheClimb) {
  TakeoffConsistencyMonitor monitor;
  monitor.begin(kBias, 0.0);
  climb(monitor, 1.0, 1.0);
  EXPECT_FALSE(climb(monitor, 1.0, 0.0).contradicted);
}

}  // namespace swiftlet::control::takeoff_consistency_test
