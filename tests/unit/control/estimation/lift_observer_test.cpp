#include "swiftlet/control/estimation/lift_observer.hpp"

#include <algorithm>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control::lift_observer_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStep_s = 0.002;

// A vehicle that stands level until the lift that its rotors give is its weight.
struct Takeoff {
  double ratio = 1.0;      // of actual and modelled lift
  double noise = 0.0;      // m/s^2, standard deviation of a sample
  double vibration = 0.0;  // of the actual lift: a standard deviation that is added to it
  double lift_rate = 6.0;  // m/s^3, modelled
  double step_s = kStep_s;
  LiftObserver observer;
  double t_s = 0.0;
  std::mt19937_64 random{1};

  double lift() const { return lift_rate * t_s; }
  Vector3d measured(double of_lift) {
    const double up = std::max(ratio * of_lift, plant::kGravity);
    const double deviation = noise + vibration * ratio * of_lift;
    return {0.0, 0.0, -up + deviation * std::normal_distribution<double>()(random)};
  }
  // The time at which lift-off is seen, or that limit.
  double until_lift_off(double limit_s) {
    while (t_s < limit_s && !observer.lifted_off()) {
      t_s += step_s;
      observer.step_on_ground(step_s, measured(lift()), Quaterniond::Identity(), lift());
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

// GIVEN vibration that rises with the thrust, at the rates of an IMU and of PX4's client THEN lift-off is not seen before it, and
// soon after it.
TEST(LiftObserver, DoesNotTakeVibrationForLiftOff) {
  for (const double step_s : {0.001, 0.002, 0.01}) {
    for (unsigned seed = 1; seed <= 200; ++seed) {
      Takeoff takeoff;
      takeoff.step_s = step_s;
      takeoff.vibration = 0.1;
      takeoff.lift_rate = 20.0;
      takeoff.random.seed(seed);
      const double lifts_at_s = plant::kGravity / takeoff.lift_rate;
      const double seen_s = takeoff.until_lift_off(5.0);
      EXPECT_GT(seen_s, lifts_at_s) << step_s << ' ' << seed;
      EXPECT_LT(seen_s, lifts_at_s + 0.35) << step_s << ' ' << seed;
      EXPECT_NEAR(takeoff.observer.ratio(), 1.0, 0.15) << step_s << ' ' << seed;
    }
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

}  // namespace swiftlet::control::lift_observer_test
