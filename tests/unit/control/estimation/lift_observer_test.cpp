#include "swiftlet/control/estimation/lift_observer.hpp"

#include <algorithm>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStep_s = 0.002;

// A vehicle that stands level until the lift that its rotors give is its weight.
struct Takeoff {
  double ratio = 1.0;      // of actual and modelled lift
  double noise = 0.0;      // m/s^2, standard deviation of a sample
  double lift_rate = 6.0;  // m/s^3, modelled
  LiftObserver observer;
  double t_s = 0.0;
  std::mt19937_64 random{1};

  double lift() const { return lift_rate * t_s; }
  Vector3d measured(double of_lift) {
    const double up = std::max(ratio * of_lift, plant::kGravity);
    return {0.0, 0.0, -up + noise * std::normal_distribution<double>()(random)};
  }
  // The time at which lift-off is seen, or that limit.
  double until_lift_off(double limit_s) {
    while (t_s < limit_s && !observer.lifted_off()) {
      t_s += kStep_s;
      observer.step_on_ground(kStep_s, measured(lift()), Quaterniond::Identity(), lift());
    }
    return t_s;
  }
};

TEST(LiftObserver, LearnsTheRatioAtLiftOff) {
  for (const double ratio : {0.75, 0.9, 1.0, 1.1, 1.3}) {
    Takeoff takeoff;
    takeoff.ratio = ratio;
    takeoff.noise = 0.09;
    const double lifts_at_s = plant::kGravity / ratio / takeoff.lift_rate;
    const double seen_s = takeoff.until_lift_off(5.0);
    ASSERT_TRUE(takeoff.observer.lifted_off()) << ratio;
    EXPECT_GT(seen_s, lifts_at_s) << ratio;
    EXPECT_LT(seen_s, lifts_at_s + 0.08) << ratio;
    EXPECT_NEAR(takeoff.observer.ratio() / ratio, 1.0, 0.02);
    for (double t = 0.0; t < 1.0; t += kStep_s)
      takeoff.observer.step_in_flight(kStep_s, takeoff.measured(plant::kGravity / ratio),
                                      plant::kGravity / ratio);
    EXPECT_NEAR(takeoff.observer.ratio() / ratio, 1.0, 0.003);
  }
}

TEST(LiftObserver, StandsStillOnTheGround) {
  Takeoff takeoff;
  takeoff.noise = 0.09;
  takeoff.ratio = 0.5;
  takeoff.until_lift_off(3.0);  // 0.9 of the weight
  EXPECT_FALSE(takeoff.observer.lifted_off());
  EXPECT_EQ(takeoff.observer.ratio(), 1.0);
}

TEST(LiftObserver, FollowsTheRatioInFlightWithinItsMemory) {
  LiftObserver observer;
  observer.adopt(0.9);
  EXPECT_EQ(observer.ratio(), 0.9);
  double longest_step = 0.0;
  for (double t = 0.0; t < 5.0; t += kStep_s) {
    const double before = observer.ratio();
    observer.step_in_flight(kStep_s, {0.0, 0.0, -1.1 * plant::kGravity}, plant::kGravity);
    longest_step = std::max(longest_step, observer.ratio() - before);
  }
  EXPECT_NEAR(observer.ratio(), 1.1, 0.002);
  EXPECT_LT(longest_step, 0.001) << "without a step";
}

TEST(LiftObserver, IgnoresInvalidInputAndStaysWithinItsBounds) {
  LiftObserver observer;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  observer.step_in_flight(kStep_s, {0.0, 0.0, nan}, plant::kGravity);
  observer.step_in_flight(kStep_s, {0.0, 0.0, -plant::kGravity}, nan);
  EXPECT_EQ(observer.ratio(), 1.0);
  for (int i = 0; i < 10'000; ++i) observer.step_in_flight(kStep_s, {0.0, 0.0, -100.0}, plant::kGravity);
  EXPECT_EQ(observer.ratio(), LiftObserver::kMost);
  for (int i = 0; i < 10'000; ++i) observer.step_in_flight(kStep_s, {0.0, 0.0, 0.0}, plant::kGravity);
  EXPECT_EQ(observer.ratio(), LiftObserver::kLeast);
  observer.reset();
  EXPECT_FALSE(observer.lifted_off());
  EXPECT_EQ(observer.ratio(), 1.0);
}

}  // namespace
}  // namespace swiftlet::control
