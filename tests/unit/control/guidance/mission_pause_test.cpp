// Missions that are paused, resumed and skipped, also across a failover.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/unit/control/guidance/mission_flight.hpp"

namespace swiftlet::control::mission_pause_test {

using namespace mission_flight;

TEST_F(MissionFlight, PauseStopsOnThePathAndResumesThere) {
  const Mission mission = curve();
  for (double pause_at_s = 0.8; pause_at_s < 6.0; pause_at_s += 0.61) {
    ASSERT_TRUE(fly(mission).accepted);
    ASSERT_NO_FATAL_FAILURE(step_smoothly(pause_at_s));
    if (supervisor_.mode() != Mode::kMission) break;
    const double speed = control_setpoint_.reference.velocity_ned.norm();
    ASSERT_TRUE(pause().accepted);
    EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
    EXPECT_EQ(supervisor_.reason(), Reason::kMissionPaused);
    EXPECT_EQ(state(), MissionState::kPaused);
    step();
    EXPECT_NEAR(control_setpoint_.reference.velocity_ned.norm(), speed, 0.01);
    ASSERT_NO_FATAL_FAILURE(step_smoothly(3.0));
    EXPECT_EQ(control_setpoint_.reference.velocity_ned, Vector3d::Zero());
    const Vector3d rest = control_setpoint_.reference.position_ned;
    EXPECT_LT(distance_from(mission.segments, rest), 2e-3) << "paused at " << pause_at_s << " s";
    fly_for(1.0);
    EXPECT_EQ(control_setpoint_.reference.position_ned, rest);
    ASSERT_TRUE(resume().accepted);
    EXPECT_EQ(state(), MissionState::kRunning);
    ASSERT_NO_FATAL_FAILURE(step_smoothly(1.0));
    EXPECT_LT(distance_from(mission.segments, control_setpoint_.reference.position_ned), 2e-3);
    ASSERT_TRUE(step_until([&] { return state() == MissionState::kCompleted; }, 20.0));
    EXPECT_NEAR((estimate_.position_ned - Vector3d(0, 0, -1)).norm(), 0.0, 1e-6);
  }
}

TEST_F(MissionFlight, PauseAndResumeAreContinuousAtAnyTime) {
  const Mission mission = curve();
  for (double after_s = 0.05; after_s < 2.2; after_s += 0.15) {
    ASSERT_TRUE(fly(mission).accepted);
    fly_for(2.0);
    ASSERT_TRUE(pause().accepted);
    ASSERT_NO_FATAL_FAILURE(step_smoothly(after_s));
    ASSERT_TRUE(resume().accepted);
    ASSERT_NO_FATAL_FAILURE(step_smoothly(after_s));
    ASSERT_TRUE(pause().accepted);
    ASSERT_NO_FATAL_FAILURE(step_smoothly(3.0));
    EXPECT_LT(distance_from(mission.segments, control_setpoint_.reference.position_ned), 2e-3);
    ASSERT_TRUE(resume().accepted);
    ASSERT_TRUE(step_until([&] { return state() == MissionState::kCompleted; }, 30.0));
  }
}

TEST_F(MissionFlight, ResumeAfterGoToReturnsToThePausedPosition) {
  const Mission mission = curve();
  for (const double pause_s : {0.4, 4.0}) {  // before it has come to rest, and after
    ASSERT_TRUE(fly(mission).accepted);
    fly_for(2.0);
    ASSERT_TRUE(pause().accepted);
    ASSERT_NO_FATAL_FAILURE(step_smoothly(pause_s));
    const Vector3d left = control_setpoint_.reference.position_ned;
    ASSERT_TRUE(ask(RequestKind::kGoTo, {-1, -1, -2}).accepted);
    EXPECT_EQ(state(), MissionState::kPaused);
    fly_for(12.0);
    EXPECT_NEAR((estimate_.position_ned - Vector3d(-1, -1, -2)).norm(), 0.0, 1e-6);
    ASSERT_TRUE(resume().accepted);
    double nearest = 1e9;
    double slowest_there = 1e9;
    ASSERT_TRUE(step_until(
        [&] {
          const double distance = (estimate_.position_ned - left).norm();
          nearest = std::min(nearest, distance);
          if (distance < 1e-3)
            slowest_there = std::min(slowest_there, control_setpoint_.reference.velocity_ned.norm());
          return state() == MissionState::kCompleted;
        },
        40.0));
    EXPECT_LT(nearest, 1e-4);
    EXPECT_LT(slowest_there, 1e-3);
    EXPECT_NEAR((estimate_.position_ned - Vector3d(0, 0, -1)).norm(), 0.0, 1e-6);
  }
}

TEST_F(MissionFlight, ReturnToThePathCanBePausedAndResumed) {
  const Mission mission = curve();
  ASSERT_TRUE(fly(mission).accepted);
  fly_for(2.0);
  ASSERT_TRUE(pause().accepted);
  fly_for(3.0);
  const Vector3d left = control_setpoint_.reference.position_ned;
  ASSERT_TRUE(ask(RequestKind::kGoTo, {-1, -1, -2}).accepted);
  fly_for(12.0);
  ASSERT_TRUE(resume().accepted);
  ASSERT_NO_FATAL_FAILURE(step_smoothly(2.0));
  ASSERT_TRUE(pause().accepted);
  ASSERT_NO_FATAL_FAILURE(step_smoothly(4.0));
  EXPECT_GT((estimate_.position_ned - left).norm(), 0.1);
  ASSERT_TRUE(resume().accepted);
  double nearest = 1e9;
  ASSERT_TRUE(step_until(
      [&] {
        nearest = std::min(nearest, (estimate_.position_ned - left).norm());
        return state() == MissionState::kCompleted;
      },
      40.0));
  EXPECT_LT(nearest, 1e-4);
}

TEST_F(MissionFlight, PauseKeepsTheRestOfAHold) {
  const Mission mission = mission_of({waypoint({0.5, 0, -1}, 0.5, 4.0), waypoint({0, 0, -1})});
  ASSERT_TRUE(fly(mission).accepted);
  ASSERT_TRUE(step_until([&] { return supervisor_.state().guidance.item_end_ns != 0; }, 10.0));
  fly_for(1.0);
  ASSERT_TRUE(pause().accepted);
  fly_for(30.0);
  EXPECT_EQ(item(), 0);
  ASSERT_TRUE(resume().accepted);
  const std::int64_t resumed_ns = inputs_.stamp_ns;
  ASSERT_TRUE(step_until([&] { return item() == 1; }, 10.0));
  const double rest_s = static_cast<double>(inputs_.stamp_ns - resumed_ns) * 1e-9;
  EXPECT_GT(rest_s, 2.4);
  EXPECT_LT(rest_s, 3.6);
}

TEST_F(MissionFlight, HoldThatEndsDuringTimeScalingIsContinuous) {
  const Mission mission = mission_of({waypoint({0.5, 0, -1}, 0.5, 0.3), waypoint({0, 0, -1})});
  for (double after_s = 0.0; after_s < 3.0; after_s += 0.1) {
    ASSERT_TRUE(fly(mission).accepted);
    ASSERT_NO_FATAL_FAILURE(step_smoothly(after_s));
    ASSERT_TRUE(pause().accepted);
    ASSERT_NO_FATAL_FAILURE(step_smoothly(3.0));
    ASSERT_TRUE(resume().accepted);
    ASSERT_NO_FATAL_FAILURE(step_smoothly(8.0));
    ASSERT_EQ(state(), MissionState::kCompleted);
  }
}

TEST_F(MissionFlight, SkipContinuesFromThePresentMotion) {
  const Mission mission =
      mission_of({waypoint({2, 0, -1}, 0.8), waypoint({0, 1, -1}, 0.8), waypoint({0, 0, -1}, 0.8)});
  ASSERT_TRUE(fly(mission).accepted);
  fly_for(2.0);
  const double speed = control_setpoint_.reference.velocity_ned.x();
  ASSERT_GT(speed, 0.3);
  ASSERT_TRUE(ask(RequestKind::kMissionSkip).accepted);
  EXPECT_EQ(item(), 1);
  step();
  EXPECT_NEAR(control_setpoint_.reference.velocity_ned.x(), speed, 0.02);
  ASSERT_TRUE(step_until([&] { return item() == 2; }, 20.0));
  EXPECT_NEAR((estimate_.position_ned - Vector3d(0, 1, -1)).norm(), 0.0, 1e-3);
}

TEST_F(MissionFlight, SkipInAPauseFliesTheNextItem) {
  const Mission mission = mission_of({waypoint({2, 0, -1}), waypoint({0, 1, -1})});
  ASSERT_TRUE(fly(mission).accepted);
  fly_for(1.5);
  ASSERT_TRUE(pause().accepted);
  fly_for(0.3);
  ASSERT_TRUE(ask(RequestKind::kMissionSkip).accepted);
  EXPECT_EQ(supervisor_.mode(), Mode::kMission);
  ASSERT_NO_FATAL_FAILURE(step_smoothly(10.0));
  EXPECT_EQ(state(), MissionState::kCompleted);
  EXPECT_NEAR((estimate_.position_ned - Vector3d(0, 1, -1)).norm(), 0.0, 1e-6);
}

TEST_F(MissionFlight, ClearInAPauseStopsAndForgetsTheMission) {
  const Mission mission = curve();
  ASSERT_TRUE(fly(mission).accepted);
  fly_for(2.0);
  ASSERT_TRUE(pause().accepted);
  fly_for(0.2);
  ASSERT_TRUE(ask(RequestKind::kMissionClear).accepted);
  EXPECT_EQ(state(), MissionState::kNone);
  EXPECT_EQ(supervisor_.mission().id, 0u);
  ASSERT_NO_FATAL_FAILURE(step_smoothly(4.0));
  EXPECT_EQ(control_setpoint_.reference.velocity_ned, Vector3d::Zero());
  EXPECT_FALSE(resume().accepted);
  EXPECT_FALSE(ask(RequestKind::kMissionStart).accepted);
}

TEST_F(MissionFlight, PauseEndsWithAnyOtherModeThanHold) {
  const Mission mission = mission_of({waypoint({2, 0, -1}), waypoint({0, 0, -1})});
  ASSERT_TRUE(fly(mission).accepted);
  fly_for(1.0);
  ASSERT_TRUE(pause().accepted);
  ASSERT_TRUE(ask(RequestKind::kHold).accepted);
  EXPECT_EQ(state(), MissionState::kPaused);
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  EXPECT_EQ(state(), MissionState::kAborted);
  EXPECT_FALSE(resume().accepted);
}

TEST_F(MissionFlight, FollowerContinuesFromAPauseAtEveryStep) {
  const Mission mission = curve();
  Supervisor follower{SupervisionSettings()};
  const auto step_both = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      const SupervisorState state = supervisor_.state();
      if (i % 5 == 0) follower.adopt(state, &mission, nullptr);
      SupervisorInputs inputs = inputs_;
      const Estimate before = estimate_;
      step();
      inputs.stamp_ns = inputs_.stamp_ns;
      inputs.estimate = &before;
      const ControlSetpoint followed = follower.step(inputs);
      ASSERT_EQ(followed.reference.position_ned, control_setpoint_.reference.position_ned);
      ASSERT_EQ(followed.reference.velocity_ned, control_setpoint_.reference.velocity_ned);
      ASSERT_EQ(followed.reference.jerk_ned, control_setpoint_.reference.jerk_ned);
      ASSERT_EQ(follower.mission().state, supervisor_.mission().state);
    }
  };
  ASSERT_TRUE(upload(mission).accepted);
  ASSERT_NO_FATAL_FAILURE(step_both(20));
  ASSERT_TRUE(ask(RequestKind::kMissionStart).accepted);
  ASSERT_NO_FATAL_FAILURE(step_both(1000));
  ASSERT_TRUE(pause().accepted);
  ASSERT_NO_FATAL_FAILURE(step_both(400));
  ASSERT_TRUE(ask(RequestKind::kGoTo, {0, -1, -1.5}).accepted);
  ASSERT_NO_FATAL_FAILURE(step_both(2000));
  ASSERT_TRUE(resume().accepted);
  ASSERT_NO_FATAL_FAILURE(step_both(8000));
  EXPECT_EQ(state(), MissionState::kCompleted);
}

TEST_F(MissionFlight, FailoverWithoutTheMissionForgetsOrAbortsIt) {
  const Mission mission = curve();
  ASSERT_TRUE(upload(mission).accepted);
  Supervisor follower{SupervisionSettings()};
  follower.adopt(SupervisorState(supervisor_.state()), nullptr, nullptr);
  EXPECT_EQ(follower.mode(), Mode::kHolding);
  EXPECT_EQ(follower.mission().state, MissionState::kNone);
  ASSERT_TRUE(ask(RequestKind::kMissionStart).accepted);
  fly_for(2.0);
  ASSERT_TRUE(pause().accepted);
  fly_for(0.2);
  follower.adopt(SupervisorState(supervisor_.state()), nullptr, nullptr);
  EXPECT_EQ(follower.mode(), Mode::kHolding);
  EXPECT_EQ(follower.reason(), Reason::kPlanUnknown);
  EXPECT_EQ(follower.mission().state, MissionState::kAborted);
}

}  // namespace swiftlet::control::mission_pause_test
