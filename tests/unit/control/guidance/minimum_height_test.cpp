// No setpoint leads below the minimum height; take-offs and landings pass it.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/math/random.hpp"
#include "tests/unit/control/supervision/supervised_flight.hpp"

namespace swiftlet::control::minimum_height_test {

using Eigen::Vector3d;
using tests::SupervisedFlight;

constexpr double kRounding_m = 1e-6;

TEST(CheckHeight, NamesBothReadingsOfAZBelowTheGround) {
  EXPECT_STREQ(
      check_height("goto", 0.1, Limits()).reason,
      "goto: z = +0.100 m is below the ground, as z points down (NED); 0.100 m above the ground is z = "
      "-0.100 m");
  EXPECT_STREQ(
      check_height("item 2", -0.05, Limits()).reason,
      "item 2: z = -0.050 m is 0.050 m above the ground; the minimum height is 0.100 m, z = -0.100 m");
  EXPECT_FALSE(check_height("goto", 0.0, Limits()).accepted);
  EXPECT_TRUE(check_height("goto", -0.1, Limits()).accepted);
  Limits low;
  low.min_height_m = 0.02;
  EXPECT_TRUE(check_height("goto", -0.05, low).accepted);
}

TEST(CheckHeight, WithoutTheSettingRefusesOnlyBelowTheGround) {
  EXPECT_FALSE(check_above_ground("goto", 0.01).accepted);
  EXPECT_TRUE(check_above_ground("goto", 0.0).accepted);
  EXPECT_TRUE(check_above_ground("goto", -0.01).accepted);
}

TEST(CheckYaw, NamesBothReadingsOfMoreThanAFullTurn) {
  EXPECT_STREQ(
      check_yaw("goto", 90.0).reason,
      "goto: yaw is 90 rad, more than a full turn: 90 degrees are 1.5708 rad, 90 rad are the yaw 2.0354 "
      "rad");
  EXPECT_TRUE(check_yaw("goto", -6.28).accepted);
  EXPECT_FALSE(check_yaw("goto", std::nan("")).accepted);
}

class MinimumHeight : public testing::Test, protected SupervisedFlight {
 protected:
  Outcome send(SetpointKind kind, const Vector3d& value) {
    Setpoint setpoint;
    setpoint.kind = kind;
    setpoint.yaw_free = true;
    setpoint.position_ned = setpoint.velocity_ned = setpoint.acceleration_ned = value;
    if (kind == SetpointKind::kPosition) setpoint.velocity_ned.setZero();
    if (kind != SetpointKind::kAcceleration) setpoint.acceleration_ned.setZero();
    return supervisor_.setpoint(setpoint, inputs_);
  }
  double height_m() const { return -control_setpoint_.reference.position_ned.z(); }
  // Sends the setpoint at 50 Hz, also after a refusal. Returns the least height of the reference until then and
  // until the vehicle rests.
  double least_height_m(SetpointKind kind, const Vector3d& value) {
    double least = height_m();
    for (int i = 0; i < 5000; ++i) {
      if (i % 10 == 0 && i < 3000) send(kind, value);
      step();
      least = std::min(least, height_m());
    }
    return least;
  }

  const double least_m_ = Limits().min_height_m;
};

TEST_F(MinimumHeight, HoldsForRequests) {
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  EXPECT_FALSE(ask(RequestKind::kTakeoff, {0, 0, -0.08}).accepted);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  ASSERT_TRUE(step_until(Mode::kHolding, 10.0));
  for (const double z : {0.1, 0.0, -0.05}) EXPECT_FALSE(ask(RequestKind::kGoTo, {1, 0, z}).accepted) << z;
  EXPECT_TRUE(ask(RequestKind::kGoTo, {1, 0, -0.1}).accepted);
  ASSERT_TRUE(step_until([&] { return estimate_.position_ned.x() > 0.999; }, 10.0));
  EXPECT_NEAR(estimate_.position_ned.z(), -0.1, 1e-3);
  Request degrees = next_request(RequestKind::kGoTo);
  degrees.position_ned = {0, 0, -1};
  degrees.yaw_free = false;
  degrees.yaw_rad = 90.0;
  EXPECT_FALSE(supervisor_.request(degrees, inputs_).accepted);
}

TEST(MinimumHeightOfPlans, HoldsForEveryPoint) {
  Mission mission;
  mission.items = {{MissionItemKind::kTakeoff, {0, 0, -1}, 0, true, 0.5, 0.0},
                   {MissionItemKind::kWaypoint, {1, 0, -0.05}, 0, true, 0.5, 0.0}};
  EXPECT_FALSE(check(mission, Limits()).accepted);
  mission.items[1].position_ned.z() = -0.1;
  EXPECT_TRUE(check(mission, Limits()).accepted);
  mission.items[0].position_ned.z() = -0.09;
  EXPECT_FALSE(check(mission, Limits()).accepted);

  // Ends at 1 m, but is lower between.
  const auto dip = [](double depth_m) {
    PolynomialSegment segment = minimum_jerk({0, 0, -1}, 0.0, {1, 0, -1}, 0.0, 10.0);
    for (int power = 3; power <= 6; ++power) {  // 64 depth s^3 (1 - s)^3, at rest at both ends
      const double binomial[] = {1.0, -3.0, 3.0, -1.0};
      segment.z[static_cast<std::size_t>(power)] +=
          64.0 * depth_m * binomial[power - 3] / std::pow(10.0, power);
    }
    return Trajectory{1, {segment}};
  };
  EXPECT_TRUE(check(dip(0.89), Limits()).accepted) << check(dip(0.89), Limits()).reason;
  EXPECT_FALSE(check(dip(0.91), Limits()).accepted);
}

TEST_F(MinimumHeight, HoldsForStreams) {
  for (const SetpointKind kind :
       {SetpointKind::kPosition, SetpointKind::kVelocity, SetpointKind::kAcceleration}) {
    SCOPED_TRACE(static_cast<int>(kind));
    if (supervisor_.mode() == Mode::kDisarmed) {
      ASSERT_TRUE(take_off());
    } else {
      ASSERT_TRUE(ask(RequestKind::kGoTo, {0, 0, -0.6}).accepted);
      step_until([] { return false; }, 5.0);
    }
    const Vector3d value = kind == SetpointKind::kPosition ? Vector3d(0, 0, 0.05) : Vector3d(0, 0, 0.4);
    const double least = least_height_m(kind, value);
    EXPECT_GE(least, least_m_ - kRounding_m);
    EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
  }
}

// An attitude stream with too little thrust sinks until it can only just stop above the minimum height.
TEST_F(MinimumHeight, EndsADirectStreamThatSinks) {
  ASSERT_TRUE(take_off());
  Setpoint level;
  level.kind = SetpointKind::kAttitude;
  level.specific_thrust = plant::kGravity;
  ASSERT_TRUE(supervisor_.setpoint(level, inputs_).accepted);
  estimate_.velocity_ned = {0, 0, 0.5};
  estimate_.position_ned.z() = -0.5;
  step();
  EXPECT_EQ(supervisor_.mode(), Mode::kSetpoint);
  estimate_.position_ned.z() = -0.2;
  step();
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
  EXPECT_EQ(supervisor_.reason(), Reason::kSetpointsViolatedFence);
}

TEST_F(MinimumHeight, IsReachedByHoldAfterAnAbortedTakeoff) {
  for (const double aborted_m : {0.004, 0.03, 0.09}) {
    SCOPED_TRACE(aborted_m);
    ASSERT_TRUE(ask(RequestKind::kArm).accepted);
    ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
    ASSERT_TRUE(step_until([&] { return height_m() > aborted_m; }, 10.0));
    ASSERT_TRUE(ask(RequestKind::kHold).accepted);
    const double from_m = height_m();
    double lowest_m = from_m;
    double last_m = from_m;
    double most_speed = 0.0;
    for (int i = 0; i < 2000; ++i) {
      step();
      lowest_m = std::min(lowest_m, height_m());
      most_speed = std::max(most_speed, std::abs(height_m() - last_m) / 0.002);
      last_m = height_m();
    }
    EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
    EXPECT_GE(height_m(), least_m_ - kRounding_m);
    EXPECT_LT(height_m(), 0.25);
    EXPECT_GE(lowest_m, from_m - kRounding_m);
    EXPECT_LT(most_speed, 0.5);
    ASSERT_TRUE(ask(RequestKind::kLand).accepted);
    ASSERT_TRUE(step_until(Mode::kDisarmed, 10.0));
  }
}

TEST_F(MinimumHeight, LetsAVehicleBelowItLandOrFlyOn) {
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  ASSERT_TRUE(step_until([&] { return height_m() > 0.04; }, 10.0));
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(step_until(Mode::kDisarmed, 10.0));
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  ASSERT_TRUE(step_until([&] { return height_m() > 0.04; }, 10.0));
  ASSERT_TRUE(ask(RequestKind::kGoTo, {0.5, 0, -0.5}).accepted);
  ASSERT_TRUE(step_until([&] { return estimate_.position_ned.x() > 0.499; }, 10.0));
  EXPECT_NEAR(height_m(), 0.5, 1e-3);
}

// A landing that is ended close to the ground.
TEST_F(MinimumHeight, IsReachedByHoldAfterAnEndedLanding) {
  ASSERT_TRUE(take_off());
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(step_until([&] { return height_m() < 0.05; }, 10.0));
  ASSERT_TRUE(ask(RequestKind::kHold).accepted);
  step_until([] { return false; }, 3.0);
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
  EXPECT_NEAR(height_m(), least_m_, kRounding_m);
}

// Requests at any moment of a fast low flight: the joins of two motions swing out, but not below.
TEST_F(MinimumHeight, HoldsWhileRequestsInterruptEachOther) {
  ASSERT_TRUE(take_off());
  math::RandomStream random(5, 1);
  for (int i = 0; i < 300; ++i) {
    const Vector3d to(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), -random.uniform(0.1, 0.6));
    const bool holds = random.uniform() < 0.2;
    ASSERT_TRUE(
        (holds ? ask(RequestKind::kHold) : ask(RequestKind::kGoTo, to, random.uniform(0.3, 2.0))).accepted);
    const int steps = static_cast<int>(random.uniform(5.0, 500.0));
    for (int k = 0; k < steps; ++k) {
      step();
      ASSERT_GE(height_m(), least_m_ - kRounding_m) << "request " << i;
    }
  }
}

}  // namespace swiftlet::control::minimum_height_test
