#include "swiftlet/control/estimation/disturbance_observer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "swiftlet/math/euler.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control::disturbance_observer_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStep_s = 0.002;
constexpr double kLift = plant::kGravity;
const Vector3d kWind(0.8, -0.5, 0.3);  // m/s^2
const Quaterniond kTilted = math::quaternion_from_euler({0.2, -0.3, 2.0});

// Specific force under a lift and a disturbance.
Vector3d specific_force(const Quaterniond& q, double lift, const Vector3d& disturbance_ned) {
  return q.conjugate() * disturbance_ned - lift * Vector3d::UnitZ();
}

TEST(DisturbanceObserver, EstimatesAConstantDisturbanceWhenTilted) {
  DisturbanceObserver observer({10.0, 3.0});
  for (int i = 0; i < 1000; ++i)
    observer.step(kStep_s, specific_force(kTilted, kLift, kWind), kTilted, kLift);
  EXPECT_LT((observer.acceleration_ned() - kWind).norm(), 1e-6);
}

TEST(DisturbanceObserver, ConvergesWithItsBandwidth) {
  constexpr double kBandwidth = 10.0;
  DisturbanceObserver observer({kBandwidth, 3.0});
  const int steps = static_cast<int>(std::lround(1.0 / kBandwidth / kStep_s));
  for (int i = 0; i < steps; ++i)
    observer.step(kStep_s, specific_force(kTilted, kLift, kWind), kTilted, kLift);
  EXPECT_NEAR(observer.acceleration_ned().norm() / kWind.norm(), 1.0 - std::exp(-1.0), 0.02);
}

TEST(DisturbanceObserver, ExtraMassIsADownwardDisturbance) {
  DisturbanceObserver observer({10.0, 3.0});
  const double measured = kLift / 1.1;  // the same thrust on 10 % more mass
  for (int i = 0; i < 1000; ++i)
    observer.step(kStep_s, {0.0, 0.0, -measured}, Quaterniond::Identity(), kLift);
  EXPECT_LT((observer.acceleration_ned() - Vector3d(0.0, 0.0, kLift - measured)).norm(), 1e-6);
}

TEST(DisturbanceObserver, StaysWithinItsLimitAndIgnoresInvalidInput) {
  DisturbanceObserver observer({10.0, 0.5});
  for (int i = 0; i < 1000; ++i)
    observer.step(kStep_s, specific_force(kTilted, kLift, kWind), kTilted, kLift);
  EXPECT_NEAR(observer.acceleration_ned().norm(), 0.5, 1e-12);
  EXPECT_LT(observer.acceleration_ned().cross(kWind).norm(), 1e-6) << "the direction is kept";

  const Vector3d before = observer.acceleration_ned();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  observer.step(kStep_s, {nan, 0.0, 0.0}, kTilted, kLift);
  observer.step(kStep_s, {0.0, 0.0, -kLift}, kTilted, nan);
  EXPECT_EQ(observer.acceleration_ned(), before);
  observer.reset();
  EXPECT_EQ(observer.acceleration_ned(), Vector3d::Zero());
}

TEST(DisturbanceObserver, IsZeroWithoutBandwidth) {
  DisturbanceObserver observer({0.0, 3.0});
  for (int i = 0; i < 100; ++i) observer.step(kStep_s, specific_force(kTilted, kLift, kWind), kTilted, kLift);
  EXPECT_EQ(observer.acceleration_ned(), Vector3d::Zero());
}

// GIVEN an estimate that still rises WHEN the bandwidth goes to 0 THEN it does not run on, and ends at 0.
TEST(DisturbanceObserver, EndsAtZeroWithABandwidthThatGoesToZero) {
  for (const bool incremental : {false, true}) {
    DisturbanceObserver observer({20.0, 3.0}, incremental);
    for (int i = 0; i <= 5000; ++i) {
      observer.set({20.0 * std::max(0.0, 1.0 - i / 20.0), 3.0});
      observer.step(kStep_s, specific_force(kTilted, kLift, kWind), kTilted, kLift);
      ASSERT_LE(observer.acceleration_ned().norm(), 1.1 * kWind.norm()) << incremental << ' ' << i;
      if (i >= 20) {
        ASSERT_TRUE(observer.acceleration_ned().isZero(0.0)) << incremental << ' ' << i;
        ASSERT_TRUE(observer.rate_ned().isZero(0.0)) << incremental << ' ' << i;
      }
    }
  }
}

// GIVEN a bandwidth that falls to nearly 0 THEN the estimate stays where it is.
TEST(DisturbanceObserver, DoesNotRunOnAtASmallBandwidth) {
  DisturbanceObserver observer({20.0, 3.0}, true);
  const auto steps = [&](int count) {
    for (int i = 0; i < count; ++i)
      observer.step(kStep_s, specific_force(kTilted, kLift, kWind), kTilted, kLift);
  };
  steps(25);
  const Vector3d before = observer.acceleration_ned();
  observer.set({1.0e-6, 3.0});
  steps(5000);
  EXPECT_LT((observer.acceleration_ned() - before).norm(), 1.0e-4);
}

TEST(DisturbanceObserver, IsStableAtLongSteps) {
  DisturbanceObserver observer({500.0, 3.0}, true);
  for (int i = 0; i < 100; ++i) observer.step(0.1, specific_force(kTilted, kLift, kWind), kTilted, kLift);
  EXPECT_LT((observer.acceleration_ned() - kWind).norm(), 1e-9);
}

}  // namespace swiftlet::control::disturbance_observer_test
