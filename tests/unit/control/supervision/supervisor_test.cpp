// Modes and requests.
#include "swiftlet/control/supervision/supervisor.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "tests/unit/control/supervision/flight_fixture.hpp"

namespace swiftlet::control::supervisor_test {

using Eigen::Vector3d;

class Supervision : public tests::FlightTest {};

TEST_F(Supervision, StartsDisarmedWithRotorsOff) {
  EXPECT_EQ(supervisor_.mode(), Mode::kDisarmed);
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kOff);
}

TEST_F(Supervision, RefusesToArmWithoutPoseBatteryOrLevel) {
  inputs_.has_estimate = false;
  EXPECT_NE(std::string(ask(RequestKind::kArm).reason).find("no mocap pose"), std::string::npos);
  inputs_.has_estimate = true;
  inputs_.pose_age_s = 2.0;
  EXPECT_NE(std::string(ask(RequestKind::kArm).reason).find("2.00 s old"), std::string::npos);
  inputs_.pose_age_s = 0.0;
  inputs_.has_battery = false;
  EXPECT_NE(std::string(ask(RequestKind::kArm).reason).find("no battery voltage"), std::string::npos);
  inputs_.has_battery = true;
  inputs_.supply_voltage_v = 3.1;
  EXPECT_NE(std::string(ask(RequestKind::kArm).reason).find("3.10 V"), std::string::npos);
  inputs_.supply_voltage_v = 3.9;
  estimate_.q_ned_from_frd = Eigen::AngleAxisd(0.6, Vector3d::UnitX());
  EXPECT_NE(std::string(ask(RequestKind::kArm).reason).find("tilted"), std::string::npos);
  estimate_.q_ned_from_frd.setIdentity();
  estimate_.position_ned.x() = 5.0;
  EXPECT_NE(std::string(ask(RequestKind::kArm).reason).find("outside the fence"), std::string::npos);
  EXPECT_EQ(supervisor_.mode(), Mode::kDisarmed);
}

TEST_F(Supervision, RefusesRequestsThatTheModeDoesNotAllow) {
  EXPECT_FALSE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  EXPECT_FALSE(ask(RequestKind::kGoTo, {0, 0, -1}).accepted);
  EXPECT_FALSE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  EXPECT_FALSE(ask(RequestKind::kTakeoff, {0, 0, 0.1}).accepted);
  EXPECT_FALSE(ask(RequestKind::kTakeoff, {0, 0, -9}).accepted);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  ASSERT_TRUE(step_until(Mode::kHolding, 10.0));
  EXPECT_FALSE(ask(RequestKind::kArm).accepted);
  EXPECT_FALSE(ask(RequestKind::kDisarm).accepted);
  EXPECT_FALSE(ask(RequestKind::kGoTo, {9, 0, -1}).accepted);
  EXPECT_FALSE(ask(RequestKind::kGoTo, {1, 0, std::numeric_limits<double>::quiet_NaN()}).accepted);
  EXPECT_FALSE(ask(RequestKind::kGoTo, {1, 0, -1}, 50.0).accepted);
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
}

TEST_F(Supervision, RequestTakesEffectInItsStep) {
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  const Outcome takeoff = step_with(RequestKind::kTakeoff, {0, 0, -1});
  ASSERT_TRUE(takeoff.accepted) << takeoff.reason;
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kSpoolUp);
}

TEST_F(Supervision, StepAnswersRequestsByItsOwnInputs) {
  inputs_.has_battery = false;
  EXPECT_FALSE(step_with(RequestKind::kArm).accepted);
  inputs_.has_battery = true;
  EXPECT_TRUE(step_with(RequestKind::kArm).accepted);
  EXPECT_EQ(supervisor_.mode(), Mode::kArmed);
}

TEST_F(Supervision, RequestFollowsTheSetpointOfTheSameStep) {
  hover();
  Setpoint setpoint;
  setpoint.position_ned = {0.2, 0, -1};
  ClientInputs clients;
  clients.setpoint = &setpoint;
  Outcome land;
  const Request request = next_request(RequestKind::kLand);
  clients.add(request, land);
  step(clients);
  EXPECT_TRUE(clients.setpoint_outcome.accepted) << clients.setpoint_outcome.reason;
  EXPECT_TRUE(land.accepted) << land.reason;
  EXPECT_EQ(supervisor_.mode(), Mode::kLanding);
}

TEST_F(Supervision, ReferenceIsContinuousOverRequests) {
  hover();
  Vector3d last = control_setpoint_.reference.position_ned;
  Vector3d last_velocity = control_setpoint_.reference.velocity_ned;
  const auto smooth = [&] {
    const Reference& r = control_setpoint_.reference;
    EXPECT_LT((r.position_ned - last).norm(), 0.006);
    EXPECT_LT((r.velocity_ned - last_velocity).norm(), 0.06);
    last = r.position_ned;
    last_velocity = r.velocity_ned;
  };
  ASSERT_TRUE(ask(RequestKind::kGoTo, {2, 0, -1}, 1.0).accepted);
  for (int i = 0; i < 900; ++i) {
    step();
    smooth();
  }
  ASSERT_TRUE(ask(RequestKind::kGoTo, {0, 2, -2}, 1.0).accepted);
  for (int i = 0; i < 700; ++i) {
    step();
    smooth();
  }
  ASSERT_TRUE(ask(RequestKind::kHold).accepted);
  for (int i = 0; i < 300; ++i) {
    step();
    smooth();
  }
  ASSERT_TRUE(ask(RequestKind::kGoTo, {-2, 0, -1}, 1.0).accepted);
  for (int i = 0; i < 700; ++i) {
    step();
    smooth();
  }
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  for (int i = 0; i < 500; ++i) {
    step();
    smooth();
  }
}

TEST_F(Supervision, FollowsSetpointsAndHoldsWhenTheyStop) {
  hover();
  Setpoint setpoint;
  setpoint.position_ned = {0.2, 0, -1};
  setpoint.velocity_ned = {0.3, 0, 0};
  ASSERT_TRUE(supervisor_.setpoint(setpoint, inputs_).accepted);
  step();
  EXPECT_EQ(supervisor_.mode(), Mode::kSetpoint);
  EXPECT_GT(control_setpoint_.reference.jerk_ned.x(), 0.0) << "the reference does not begin to move";
  EXPECT_LT(control_setpoint_.reference.velocity_ned.norm(), 0.01)
      << "the reference does not start from rest";
  setpoint.position_ned = {0.2, 9.0, -1};
  EXPECT_FALSE(supervisor_.setpoint(setpoint, inputs_).accepted);
  setpoint.position_ned = {2.9, 0, -1};
  estimate_.position_ned = setpoint.position_ned;
  const Outcome outcome = supervisor_.setpoint(setpoint, inputs_);
  EXPECT_STREQ(outcome.reason,
               "setpoint: stopping point: x is 3.203 m, outside the fence of -3.000 to 3.000 m");
  ASSERT_TRUE(step_until(Mode::kHolding, 0.85));
  EXPECT_EQ(supervisor_.reason(), Reason::kSetpointsStopped);
}

TEST_F(Supervision, FliesATrajectoryFromItsStartToItsEnd) {
  hover();
  Trajectory trajectory;
  trajectory.segments = {minimum_jerk({0.5, 0, -1}, 0.0, {0.5, 1, -1}, 0.0, 4.0),
                         minimum_jerk({0.5, 1, -1}, 0.0, {0, 1, -1.5}, 0.0, 3.0)};
  ASSERT_TRUE(check(trajectory, Limits{}).accepted) << check(trajectory, Limits{}).reason;
  Request request;
  request.kind = RequestKind::kTrajectory;
  request.trajectory = &trajectory;
  ASSERT_TRUE(supervisor_.request(request, inputs_).accepted);
  EXPECT_EQ(supervisor_.mode(), Mode::kTrajectory);
  ASSERT_TRUE(step_until(Mode::kHolding, 12.0));
  EXPECT_NEAR((estimate_.position_ned - Vector3d(0, 1, -1.5)).norm(), 0.0, 1e-3);
}

}  // namespace swiftlet::control::supervisor_test
