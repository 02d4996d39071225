#include "swiftlet/control/estimation/takeoff_consistency.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStep_s = 0.002;
const Vector3d kBias(0.1, -0.2, 0.3);  // m/s^2

struct Climbed {
  bool contradicted = false;
  double height_m = 0.0;  // then, or at the end
};

// Up to 1 m along a cosine, tilted. seen: the part of the height that the pose shows.
Climbed climb(TakeoffConsistencyMonitor& watch, double duration_s, double seen,
              const Vector3d& error_frd = Vector3d::Zero()) {
  const Quaterniond tilted(Eigen::AngleAxisd(0.2, Vector3d::UnitX()));
  const double omega = M_PI / duration_s;
  Climbed out;
  for (double t = 0.0; t < duration_s && !out.contradicted; t += kStep_s) {
    out.height_m = 0.5 * (1.0 - std::cos(omega * t));
    const double upward = 0.5 * omega * omega * std::cos(omega * t);
    const Vector3d force_ned(0.0, 0.0, -upward - plant::kGravity);
    watch.step(kStep_s, tilted.conjugate() * force_ned + kBias + error_frd, tilted, -seen * out.height_m);
    out.contradicted = watch.contradicted();
  }
  return out;
}

class Climb : public testing::TestWithParam<double> {
 protected:
  Climb() { watch_.begin(kBias, 0.0); }
  TakeoffConsistencyMonitor watch_;
};

TEST_P(Climb, ThatThePoseShowsIsNotContradicted) {
  EXPECT_FALSE(climb(watch_, GetParam(), 1.0).contradicted);
}

TEST_P(Climb, ThatThePoseShowsIsNotContradictedByALittleBias) {
  for (const double bias : {-0.15, 0.15}) {
    watch_.begin(kBias, 0.0);
    EXPECT_FALSE(climb(watch_, GetParam(), 1.0, {0.0, 0.0, bias}).contradicted) << bias;
  }
}

TEST_P(Climb, ThatThePoseDoesNotShowIsContradictedLow) {
  const Climbed out = climb(watch_, GetParam(), 0.0);
  EXPECT_TRUE(out.contradicted);
  EXPECT_LT(out.height_m, 0.25);
}

TEST_P(Climb, IsNotWatchedUnlessItBegan) {
  TakeoffConsistencyMonitor idle;
  EXPECT_FALSE(climb(idle, GetParam(), 0.0).contradicted);
}

INSTANTIATE_TEST_SUITE_P(Seconds, Climb, testing::Values(1.0, 1.5, 2.5), [](const auto& param) {
  return std::to_string(static_cast<int>(param.param * 10)) + "Tenths";
});

TEST(TakeoffConsistencyMonitor, AVehicleThatStandsIsNoClimb) {
  TakeoffConsistencyMonitor watch;
  watch.begin(kBias, 0.0);
  for (int i = 0; i < 3000; ++i) {
    watch.step(kStep_s, kBias + Vector3d(0.0, 0.0, -plant::kGravity - 0.15), Quaterniond::Identity(), 0.0);
    ASSERT_FALSE(watch.contradicted()) << i;
  }
}

TEST(TakeoffConsistencyMonitor, EndsOnceTheClimbWasSeen) {
  TakeoffConsistencyMonitor watch;
  watch.begin(kBias, 0.0);
  climb(watch, 1.0, 1.0);
  EXPECT_FALSE(climb(watch, 1.0, 0.0).contradicted);
}

}  // namespace
}  // namespace swiftlet::control
