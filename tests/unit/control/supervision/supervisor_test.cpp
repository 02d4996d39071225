#include "swiftlet/control/supervision/supervisor.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "tests/unit/control/supervision/supervised_flight.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Vector3d;
using tests::SupervisedFlight;

class Flight : public testing::Test, protected SupervisedFlight {
 protected:
  void hover() { ASSERT_TRUE(take_off()); }
};

TEST_F(Flight, StartsDisarmedWithRotorsOff) {
  EXPECT_EQ(supervisor_.mode(), Mode::kDisarmed);
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kOff);
}

TEST_F(Flight, TakesOffHoldsAndLands) {
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  step();
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kIdle);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  step();
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kSpoolUp);
  ASSERT_TRUE(step_until(Mode::kHolding, 10.0));
  EXPECT_NEAR(estimate_.position_ned.z(), -1.0, 1e-9);
  EXPECT_TRUE(supervisor_.airborne());
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(step_until(Mode::kDisarmed, 10.0));
  EXPECT_EQ(supervisor_.reason(), Reason::kLanded);
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kOff);
  EXPECT_FALSE(supervisor_.airborne());
}

// On the ground the contact force would wind up the integrals.
TEST_F(Flight, IntegratesInTheAirOnly) {
  const auto check_at_height = [&] {
    const double height_m = -estimate_.position_ned.z();
    if (height_m < 0.01 || height_m > 0.2) {
      EXPECT_EQ(control_setpoint_.integrate, height_m > 0.2) << height_m << " m";
    }
  };
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  const auto flies_until = [&](Mode mode) {
    return step_until(
        [&] {
          check_at_height();
          return supervisor_.mode() == mode;
        },
        20.0);
  };
  ASSERT_TRUE(flies_until(Mode::kHolding));
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(flies_until(Mode::kDisarmed));
}

// A push at the end of a landing, while the rotors still carry nearly the weight.
TEST_F(Flight, DetectsLandingWhileSliding) {
  for (const double height_m : {0.0, 0.3}) {
    SupervisedFlight flight;
    ASSERT_TRUE(flight.take_off());
    ASSERT_TRUE(flight.ask(RequestKind::kLand).accepted);
    ASSERT_TRUE(
        flight.step_until([&] { return flight.estimate_.position_ned.z() > -height_m - 0.02; }, 10.0));
    flight.follows_ = false;
    flight.estimate_.velocity_ned = {0.3, 0.0, 0.0};
    EXPECT_EQ(flight.step_until(Mode::kDisarmed, 3.0), height_m == 0.0) << height_m;
  }
}

TEST_F(Flight, LandingRequestedNearTheGroundDoesNotRise) {
  hover();
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(step_until([&] { return estimate_.position_ned.z() > -0.01; }, 10.0));
  ASSERT_TRUE(ask(RequestKind::kHold).accepted);
  const double before_z = control_setpoint_.reference.position_ned.z();
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  while (supervisor_.mode() == Mode::kLanding) {
    step();
    ASSERT_GT(control_setpoint_.reference.position_ned.z(), before_z - 0.02);
  }
  EXPECT_EQ(supervisor_.reason(), Reason::kLanded);
}

TEST_F(Flight, FliesTheItemsOfAMissionInOrderAndCompletesIt) {
  Mission mission;
  mission.id = 7;
  mission.items = {{MissionItemKind::kTakeoff, {0, 0, -1}, 0, true, 0.5, 0.5},
                   {MissionItemKind::kWaypoint, {1, 0, -1}, 0, true, 0.5, 0.25},
                   {MissionItemKind::kWaypoint, {1, 1, -1.5}, 1.0, false, 0.5, 0.0},
                   {MissionItemKind::kLand, {0, 0, 0}, 0, true, 0.4, 0.0}};
  ASSERT_TRUE(check(mission, Limits{}).accepted);
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(fly(mission).accepted);
  ASSERT_TRUE(step_until([&] { return supervisor_.mission().item_index == 1; }, 10.0));
  EXPECT_NEAR(estimate_.position_ned.z(), -1.0, 1e-3);
  ASSERT_TRUE(step_until([&] { return supervisor_.mission().item_index == 2; }, 10.0));
  EXPECT_NEAR((estimate_.position_ned - Vector3d(1, 0, -1)).norm(), 0.0, 1e-3);
  ASSERT_TRUE(step_until([&] { return supervisor_.mission().item_index == 3; }, 10.0));
  EXPECT_NEAR((estimate_.position_ned - Vector3d(1, 1, -1.5)).norm(), 0.0, 1e-3);
  EXPECT_NEAR(control_setpoint_.reference.yaw_rad, 1.0, 1e-3);
  ASSERT_TRUE(step_until(Mode::kDisarmed, 20.0));
  EXPECT_EQ(supervisor_.mission().state, MissionState::kCompleted);
  EXPECT_EQ(supervisor_.mission().id, 7u);
}

TEST_F(Flight, ReferenceIsContinuousOverRequests) {
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

TEST_F(Flight, RefusesToArmWithoutPoseBatteryOrLevel) {
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

TEST_F(Flight, RefusesRequestsThatTheModeDoesNotAllow) {
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

TEST_F(Flight, PoseLossDescendsLevelAndItsReturnHolds) {
  hover();
  inputs_.pose_age_s = 0.4;
  step();
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
  inputs_.pose_age_s = 0.6;
  step();
  EXPECT_EQ(supervisor_.mode(), Mode::kDescent);
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kLevelDescent);
  inputs_.pose_age_s = 0.0;
  step();
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
}

TEST_F(Flight, DescentWithoutPositionEndsOnTheGroundOrByTimeout) {
  hover();
  inputs_.pose_age_s = 1.0;
  ASSERT_TRUE(step_until(Mode::kDescent, 0.1));
  inputs_.vertical_specific_force_residual = 2.0;
  ASSERT_TRUE(step_until(Mode::kDisarmed, 1.0));
  inputs_.vertical_specific_force_residual = 0.0;
  inputs_.pose_age_s = 0.0;
  estimate_ = Estimate();
  hover();
  inputs_.pose_age_s = 1.0;
  ASSERT_TRUE(step_until(Mode::kStopped, 8.0));
  EXPECT_EQ(supervisor_.reason(), Reason::kDescentTimedOut);
}

// Each descent has its own timeout: several of 4 s do not add up.
TEST_F(Flight, DescentTimeoutStartsWithEachDescent) {
  hover();
  for (int descent = 0; descent < 3; ++descent) {
    inputs_.pose_age_s = 1.0;
    ASSERT_TRUE(step_until(Mode::kDescent, 0.1));
    ASSERT_FALSE(step_until(Mode::kStopped, 4.0)) << descent;
    inputs_.pose_age_s = 0.0;
    ASSERT_TRUE(step_until(Mode::kHolding, 0.1));
    for (int i = 0; i < 50; ++i) step();
  }
}

// GIVEN a short ground contact in a canceled landing, WHEN the pose is lost later at 1 m, THEN a gust of two
// samples does not count as the rest of that contact.
TEST_F(Flight, ForgetsContactOfACanceledLanding) {
  hover();
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(step_until([&] { return supervisor_.state().contact_since_ns != 0; }, 20.0))
      << "no ground contact";
  ASSERT_EQ(supervisor_.mode(), Mode::kLanding);
  ASSERT_TRUE(ask(RequestKind::kGoTo, {0, 0, -1}).accepted);
  ASSERT_TRUE(step_until([&] { return estimate_.position_ned.z() < -0.99; }, 20.0));
  inputs_.pose_age_s = 1.0;
  ASSERT_TRUE(step_until(Mode::kDescent, 0.1));
  inputs_.vertical_specific_force_residual = 2.0;
  step();
  step();
  EXPECT_EQ(supervisor_.mode(), Mode::kDescent);
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kLevelDescent);
}

// A landing needs contact for 0.2 s, a descent without position for 0.3 s of its own.
TEST_F(Flight, DescentDoesNotContinueTheContactOfALanding) {
  hover();
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(step_until([&] { return supervisor_.state().contact_since_ns != 0; }, 20.0));
  for (int i = 0; i < 75; ++i) step();
  ASSERT_EQ(supervisor_.mode(), Mode::kLanding);
  inputs_.pose_age_s = 1.0;
  inputs_.vertical_specific_force_residual = 2.0;
  for (int i = 0; i < 125; ++i) step();
  EXPECT_EQ(supervisor_.mode(), Mode::kDescent) << "after 0.25 s";
  ASSERT_TRUE(step_until(Mode::kDisarmed, 0.1));
}

TEST_F(Flight, ForgetsContactBeforeThePoseReturned) {
  hover();
  inputs_.pose_age_s = 1.0;
  ASSERT_TRUE(step_until(Mode::kDescent, 0.1));
  inputs_.vertical_specific_force_residual = 2.0;
  for (int i = 0; i < 50; ++i) step();
  inputs_.pose_age_s = 0.0;
  ASSERT_TRUE(step_until(Mode::kHolding, 0.1));
  inputs_.vertical_specific_force_residual = 0.0;
  for (int i = 0; i < 500; ++i) step();
  inputs_.pose_age_s = 1.0;
  inputs_.vertical_specific_force_residual = 2.0;
  for (int i = 0; i < 10; ++i) step();
  EXPECT_EQ(supervisor_.mode(), Mode::kDescent);
}

// A low battery at the end of a flight does not count for its replacement, whose voltage sags briefly as the
// rotors start.
TEST_F(Flight, ForgetsALowBatteryOnTheGround) {
  for (const double voltage_v : {3.2, 2.9}) {
    SupervisedFlight flight;
    ASSERT_TRUE(flight.take_off());
    flight.inputs_.supply_voltage_v = voltage_v;
    for (int i = 0; i < 20; ++i) flight.step();
    ASSERT_TRUE(flight.ask(RequestKind::kStop).accepted);
    ASSERT_TRUE(flight.ask(RequestKind::kDisarm).accepted);
    flight.estimate_ = Estimate();
    flight.inputs_.supply_voltage_v = 4.0;
    for (int i = 0; i < 2500; ++i) flight.step();
    ASSERT_TRUE(flight.ask(RequestKind::kArm).accepted);
    ASSERT_TRUE(flight.ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
    flight.inputs_.supply_voltage_v = voltage_v;
    for (int i = 0; i < 5; ++i) flight.step();
    EXPECT_EQ(flight.supervisor_.mode(), Mode::kTakingOff) << voltage_v;
  }
}

TEST_F(Flight, TippingOverStopsTheRotors) {
  hover();
  estimate_.q_ned_from_frd = Eigen::AngleAxisd(1.6, Vector3d::UnitY());
  step();
  EXPECT_EQ(supervisor_.mode(), Mode::kStopped);
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kOff);
  ASSERT_TRUE(ask(RequestKind::kDisarm).accepted);
  EXPECT_EQ(supervisor_.mode(), Mode::kDisarmed);
}

TEST_F(Flight, LandsOnlyIfTheBatteryStaysLow) {
  hover();
  inputs_.supply_voltage_v = 3.2;
  for (int i = 0; i < 250; ++i) step();
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
  inputs_.supply_voltage_v = 3.5;
  step();
  inputs_.supply_voltage_v = 3.2;
  ASSERT_TRUE(step_until(Mode::kLanding, 1.5));
  EXPECT_EQ(supervisor_.reason(), Reason::kBatteryLow);
}

TEST_F(Flight, AbortsAnInterruptedMission) {
  Mission mission;
  mission.id = 3;
  mission.items = {{MissionItemKind::kTakeoff, {0, 0, -1}, 0, true, 0.5, 0.0},
                   {MissionItemKind::kWaypoint, {2, 0, -1}, 0, true, 0.5, 0.0}};
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(fly(mission).accepted);
  ASSERT_TRUE(step_until([&] { return supervisor_.mission().item_index == 1; }, 10.0));
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  EXPECT_EQ(supervisor_.mission().state, MissionState::kAborted);
  ASSERT_TRUE(step_until(Mode::kDisarmed, 20.0));
  EXPECT_EQ(supervisor_.mission().state, MissionState::kAborted);
}

TEST_F(Flight, FollowsSetpointsAndHoldsWhenTheyStop) {
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

TEST_F(Flight, RequestTakesEffectInItsStep) {
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  const Outcome takeoff = step_with(RequestKind::kTakeoff, {0, 0, -1});
  ASSERT_TRUE(takeoff.accepted) << takeoff.reason;
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kSpoolUp);
}

// GIVEN a take-off whose lift-off is observed WHEN the vehicle has left the ground THEN nothing stops its rotors as
// on the ground.
TEST_F(Flight, IsInTheAirFromItsLiftOffOn) {
  const auto lift_off = [&](bool observed) {
    ASSERT_TRUE(ask(RequestKind::kStop).accepted);
    ASSERT_TRUE(ask(RequestKind::kDisarm).accepted);
    estimate_ = Estimate();
    inputs_.pose_age_s = inputs_.battery_age_s = 0.0;
    inputs_.lift_off_ns = kNoLiftOffYet;
    ASSERT_TRUE(ask(RequestKind::kArm).accepted);
    ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
    for (int i = 0; i < 100; ++i) step();
    ASSERT_EQ(supervisor_.state().guidance.phase, Phase::kSpoolUp);
    if (!observed) return;
    inputs_.lift_off_ns = inputs_.stamp_ns;
    estimate_.position_ned.z() = -0.002;
    step();
    ASSERT_EQ(supervisor_.state().guidance.phase, Phase::kSpoolUp) << "until it is clear of the ground";
  };
  const auto outcome = [&](bool observed, const std::function<void()>& happens) {
    lift_off(observed);
    happens();
    step();
    return supervisor_.mode();
  };
  const auto disarm = [&] { ask(RequestKind::kDisarm); };
  EXPECT_EQ(outcome(false, disarm), Mode::kDisarmed);
  EXPECT_EQ(outcome(true, disarm), Mode::kTakingOff);
  const auto land = [&] { EXPECT_TRUE(ask(RequestKind::kLand).accepted); };
  EXPECT_EQ(outcome(false, land), Mode::kDisarmed);
  EXPECT_EQ(outcome(true, land), Mode::kLanding);
  const auto lose_pose = [&] { inputs_.pose_age_s = 10.0; };
  EXPECT_EQ(outcome(false, lose_pose), Mode::kDisarmed);
  EXPECT_EQ(outcome(true, lose_pose), Mode::kDescent);
  const auto lose_battery = [&] { inputs_.battery_age_s = 10.0; };
  EXPECT_EQ(outcome(false, lose_battery), Mode::kDisarmed);
  EXPECT_EQ(outcome(true, lose_battery), Mode::kLanding);
  const auto hold = [&] { ask(RequestKind::kHold); };
  EXPECT_EQ(outcome(true, hold), Mode::kHolding);
  EXPECT_TRUE(step_until([&] { return estimate_.position_ned.z() < -0.05; }, 3.0)) << "at the minimum height";
}

// A mission that has lifted off, but does not climb yet, cannot be paused: it would not climb.
TEST_F(Flight, PausesNoMissionThatRisesFromTheGround) {
  Mission mission;
  mission.id = 3;
  mission.items = {{MissionItemKind::kTakeoff, {0, 0, -1}, 0, true, 0.5, 0.0},
                   {MissionItemKind::kLand, {0, 0, 0}, 0, true, 0.4, 0.0}};
  inputs_.lift_off_ns = kNoLiftOffYet;
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(fly(mission).accepted);
  for (int i = 0; i < 100; ++i) step();
  inputs_.lift_off_ns = inputs_.stamp_ns;
  step();
  EXPECT_STREQ(ask(RequestKind::kMissionPause).reason, "the mission has not taken off yet");
  EXPECT_TRUE(step_until(Mode::kDisarmed, 20.0));
  EXPECT_EQ(supervisor_.mission().state, MissionState::kCompleted);
}

// GIVEN a vehicle that never reports that its rotors run WHEN it is to take off THEN the take-off ends after 10 s with that reason, and one
// that reports it after 9 s takes off.
TEST_F(Flight, TakeOffEndsIfTheRotorsAreNotReportedToRun) {
  inputs_.rotors_running = false;
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  EXPECT_FALSE(step_until(Mode::kDisarmed, 9.9));
  EXPECT_TRUE(step_until(Mode::kDisarmed, 0.2));
  EXPECT_EQ(supervisor_.reason(), Reason::kRotorsNotRunning);

  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  EXPECT_FALSE(step_until(Mode::kDisarmed, 9.0));
  inputs_.rotors_running = true;
  EXPECT_TRUE(step_until(Mode::kHolding, 10.0));
}

// GIVEN commands that the vehicle obeys late WHEN it spools up THEN the lift rises by no more than 0.08 of the weight in that time.
TEST_F(Flight, LiftRisesSlowerOverALinkWithDelay) {
  const auto steepest_rise = [&](double delay_s) {
    inputs_.command_delay_s = delay_s;
    inputs_.lift_off_ns = kNoLiftOffYet;
    EXPECT_TRUE(ask(RequestKind::kArm).accepted);
    EXPECT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
    step();
    double steepest = 0.0;
    double before = 1.0;
    std::int64_t before_ns = inputs_.stamp_ns;
    step_until(
        [&] {
          const double lift = control_setpoint_.lift_fraction;
          if (before > 0.8 && before < 1.0 && lift > before)
            steepest = std::max(steepest, (lift - before) / elapsed_s(before_ns, inputs_.stamp_ns));
          before = lift;
          before_ns = inputs_.stamp_ns;
          return lift > 1.2;
        },
        3.0);
    EXPECT_TRUE(ask(RequestKind::kDisarm).accepted);
    return steepest;
  };
  EXPECT_NEAR(steepest_rise(0.002), 3.0, 1e-6);
  EXPECT_NEAR(steepest_rise(0.08), 1.0, 1e-6);
  EXPECT_NEAR(steepest_rise(0.16), 0.5, 1e-6);
}

TEST_F(Flight, StepAnswersRequestsByItsOwnInputs) {
  inputs_.has_battery = false;
  EXPECT_FALSE(step_with(RequestKind::kArm).accepted);
  inputs_.has_battery = true;
  EXPECT_TRUE(step_with(RequestKind::kArm).accepted);
  EXPECT_EQ(supervisor_.mode(), Mode::kArmed);
}

TEST_F(Flight, FailsafeOverridesARequestOfTheSameStep) {
  hover();
  inputs_.pose_age_s = 10.0;
  step_with(RequestKind::kHold);
  EXPECT_EQ(supervisor_.mode(), Mode::kDescent);
}

TEST_F(Flight, RequestFollowsTheSetpointOfTheSameStep) {
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

TEST_F(Flight, FliesATrajectoryFromItsStartToItsEnd) {
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

bool same(const ControlSetpoint& a, const ControlSetpoint& b) {
  return a.control_mode == b.control_mode && a.lift_fraction == b.lift_fraction &&
         a.integrate == b.integrate && a.reference.position_ned == b.reference.position_ned &&
         a.reference.velocity_ned == b.reference.velocity_ned &&
         a.reference.acceleration_ned == b.reference.acceleration_ned &&
         a.reference.jerk_ned == b.reference.jerk_ned && a.reference.snap_ned == b.reference.snap_ned &&
         a.reference.yaw_rad == b.reference.yaw_rad && a.reference.yaw_rate == b.reference.yaw_rate;
}

TEST_F(Flight, FollowerContinuesFromItsStateAtEveryStep) {
  Mission mission;
  mission.id = 5;
  mission.items = {{MissionItemKind::kTakeoff, {0, 0, -1}, 0, true, 0.5, 0.2},
                   {MissionItemKind::kWaypoint, {1, 0, -1}, 1.0, false, 1.0, 0.2},
                   {MissionItemKind::kLand, {0, 0, 0}, 0, true, 0.4, 0.0}};
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(fly(mission).accepted);
  Supervisor follower{SupervisionSettings()};
  int steps = 0;
  while (supervisor_.mode() == Mode::kMission) {
    if (++steps % 7 == 0) {
      const SupervisorState state = supervisor_.state();
      follower.adopt(state, &mission, nullptr);
    }
    SupervisorInputs inputs = inputs_;
    const Estimate before = estimate_;
    step();
    if (steps < 7) continue;
    inputs.stamp_ns = inputs_.stamp_ns;
    inputs.estimate = &before;
    ASSERT_TRUE(same(follower.step(inputs), control_setpoint_)) << "at step " << steps;
    ASSERT_EQ(follower.mode(), supervisor_.mode());
  }
  EXPECT_EQ(supervisor_.reason(), Reason::kLanded);
  EXPECT_EQ(follower.mission().state, MissionState::kCompleted);
}

TEST_F(Flight, FailoverWithAnUnknownMissionHolds) {
  hover();
  Mission mission;
  mission.id = 5;
  mission.items = {{MissionItemKind::kWaypoint, {2, 0, -1}, 0, true, 1.0, 0.0}};
  ASSERT_TRUE(fly(mission).accepted);
  for (int i = 0; i < 500; ++i) step();
  const Reference before = control_setpoint_.reference;
  ASSERT_GT(before.velocity_ned.x(), 0.3);
  Mission other = mission;
  other.id = 6;
  const SupervisorState state = supervisor_.state();
  supervisor_.adopt(state, &other, nullptr);
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
  EXPECT_EQ(supervisor_.reason(), Reason::kPlanUnknown);
  EXPECT_EQ(supervisor_.mission().state, MissionState::kAborted);
  step();
  EXPECT_NEAR(control_setpoint_.reference.velocity_ned.x(), before.velocity_ned.x(), 0.02);
  for (int i = 0; i < 1000; ++i) step();
  EXPECT_EQ(control_setpoint_.reference.velocity_ned, Vector3d::Zero());
}

TEST(PlanChecks, RefuseMissionsWithItemValueAndLimit) {
  const Limits limits;
  Mission mission;
  EXPECT_FALSE(check(mission, limits).accepted);
  const MissionItem good{MissionItemKind::kWaypoint, {1, 0, -1}, 0, true, 0.5, 0.0};
  const auto reason_of = [&](const MissionItem& item) {
    mission.items = {good, item, good};
    return std::string(check(mission, limits).reason);
  };
  MissionItem bad = good;
  bad.position_ned.x() = 7.0;
  EXPECT_NE(reason_of(bad).find("item 2: x is 7.000 m, outside the fence"), std::string::npos);
  bad = good;
  bad.speed = 9.0;
  EXPECT_NE(reason_of(bad).find("item 2: speed is 9.000 m/s"), std::string::npos);
  bad = good;
  bad.hold_s = -1.0;
  EXPECT_NE(reason_of(bad).find("item 2: hold"), std::string::npos);
  bad = good;
  bad.yaw_free = false;
  bad.yaw_rad = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(reason_of(bad).find("item 2: yaw"), std::string::npos);
  bad = good;
  bad.kind = MissionItemKind::kLand;
  EXPECT_NE(reason_of(bad).find("last item"), std::string::npos);
  bad.kind = MissionItemKind::kTakeoff;
  EXPECT_NE(reason_of(bad).find("first item"), std::string::npos);
  mission.items.assign(kMaxMissionItems, good);
  EXPECT_TRUE(check(mission, limits).accepted);
  mission.items.push_back(good);
  EXPECT_NE(std::string(check(mission, limits).reason).find("2049 items"), std::string::npos);
}

TEST(PlanChecks, RefuseDiscontinuousOutsideOrFastTrajectories) {
  const Limits limits;
  Trajectory trajectory;
  EXPECT_FALSE(check(trajectory, limits).accepted);
  trajectory.segments = {minimum_jerk({0, 0, -1}, 0, {1, 0, -1}, 0, 3.0),
                         minimum_jerk({1.1, 0, -1}, 0, {0, 0, -1}, 0, 3.0)};
  EXPECT_NE(std::string(check(trajectory, limits).reason).find("segment 2 does not start"),
            std::string::npos);
  trajectory.segments = {minimum_jerk({0, 0, -1}, 0, {8, 0, -1}, 0, 30.0)};
  EXPECT_NE(std::string(check(trajectory, limits).reason).find("outside the fence"), std::string::npos);
  trajectory.segments = {minimum_jerk({0, 0, -1}, 0, {2, 0, -1}, 0, 1.6)};
  EXPECT_NE(std::string(check(trajectory, limits).reason).find("m/s, the limit"), std::string::npos);
  trajectory.segments = {minimum_jerk({0, 0, -1}, 0, {2, 0, -1}, 0, 5.0)};
  trajectory.segments[0].y[3] = std::numeric_limits<double>::infinity();
  EXPECT_NE(std::string(check(trajectory, limits).reason).find("not a finite"), std::string::npos);
  trajectory.segments[0].y[3] = 0.0;
  trajectory.segments[0].duration_s = 0.0;
  EXPECT_NE(std::string(check(trajectory, limits).reason).find("duration"), std::string::npos);
}

}  // namespace
}  // namespace swiftlet::control
