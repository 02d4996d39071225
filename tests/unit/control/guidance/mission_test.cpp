// Upload, start, pause, resume, skip and clear of missions, and the bounds that they set.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/planning/waypoint_path.hpp"
#include "tests/unit/control/supervision/supervised_flight.hpp"

namespace swiftlet::control::mission_test {

using Eigen::Vector3d;
using tests::SupervisedFlight;

MissionItem waypoint(const Vector3d& position_ned, double speed = 0.5, double hold_s = 0.0) {
  return {MissionItemKind::kWaypoint, position_ned, 0.0, true, speed, hold_s};
}

Mission mission_of(std::vector<MissionItem> items, std::uint64_t id = 7) {
  Mission mission;
  mission.id = id;
  mission.items = std::move(items);
  return mission;
}

// A curve in three axes, flown without stopping.
Mission curve(std::vector<Vector3d>* points = nullptr) {
  WaypointPath path;
  for (const Vector3d& p : {Vector3d(0, 0, -1), Vector3d(1, 0.5, -1.5), Vector3d(2, 0, -1),
                            Vector3d(1, -1, -0.8), Vector3d(0, 0, -1)}) {
    path.points.push_back({p, 0.0, false});
    if (points != nullptr) points->push_back(p);
  }
  path.limits = {1.5, 2.0, 20.0, 1.5};
  Mission mission = mission_of({});
  mission.segments = plan(path).segments;
  mission.items = {{MissionItemKind::kTrajectory, Vector3d::Zero(), 0.0, true, 0.5, 0.0, 0,
                    static_cast<std::uint32_t>(mission.segments.size())}};
  return mission;
}

// Distance of a position from the path of these segments, sampled every ms.
double distance_from(const std::vector<PolynomialSegment>& segments, const Vector3d& place) {
  double least = 1e9;
  for (const PolynomialSegment& segment : segments) {
    for (double t = 0.0; t <= segment.duration_s; t += 0.001)
      least = std::min(least, (evaluate(segment, t).position_ned - place).norm());
  }
  return least;
}

class MissionFlight : public testing::Test, protected SupervisedFlight {
 protected:
  void SetUp() override { ASSERT_TRUE(take_off()); }
  MissionState state() const { return supervisor_.mission().state; }
  int item() const { return supervisor_.mission().item_index; }
  Outcome pause() { return ask(RequestKind::kMissionPause); }
  Outcome resume() { return ask(RequestKind::kMissionResume); }
  void fly_for(double seconds) {
    step_until([] { return false; }, seconds);
  }

  // Steps and checks that the reference is continuous and that its derivatives match its position.
  void step_smoothly(double seconds, const Limits& limits = {}) {
    const double dt = static_cast<double>(kStep_ns) * 1e-9;
    std::optional<Reference> before;
    const std::int64_t end_ns = inputs_.stamp_ns + std::llround(seconds * 1e9);
    while (inputs_.stamp_ns < end_ns) {
      step();
      const Reference& r = control_setpoint_.reference;
      if (before) {
        const Vector3d velocity = (r.position_ned - before->position_ned) / dt;
        const Vector3d acceleration = (r.velocity_ned - before->velocity_ned) / dt;
        ASSERT_LT((velocity - 0.5 * (r.velocity_ned + before->velocity_ned)).norm(), 2e-4);
        ASSERT_LT((acceleration - 0.5 * (r.acceleration_ned + before->acceleration_ned)).norm(), 0.02);
        ASSERT_LT(r.acceleration_ned.norm(), 2.0 * limits.max_reference_acceleration + 1e-6);
      }
      before = r;
    }
  }
};

TEST_F(MissionFlight, UploadedMissionWaitsForStart) {
  const Mission mission = mission_of({waypoint({1, 0, -1})});
  ASSERT_TRUE(upload(mission).accepted);
  fly_for(2.0);
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
  EXPECT_EQ(state(), MissionState::kUploaded);
  EXPECT_EQ(supervisor_.mission().id, 7u);
  EXPECT_NEAR(estimate_.position_ned.x(), 0.0, 1e-9);
  ASSERT_TRUE(ask(RequestKind::kMissionStart).accepted);
  EXPECT_EQ(state(), MissionState::kRunning);
  ASSERT_TRUE(step_until(Mode::kHolding, 10.0));
  EXPECT_EQ(state(), MissionState::kCompleted);
  EXPECT_NEAR(estimate_.position_ned.x(), 1.0, 1e-6);
}

TEST_F(MissionFlight, EndedMissionCanBeStartedAgain) {
  const Mission mission = mission_of({waypoint({1, 0, -1}), waypoint({0, 0, -1})});
  ASSERT_TRUE(fly(mission).accepted);
  ASSERT_TRUE(step_until([&] { return item() == 1; }, 10.0));
  ASSERT_TRUE(ask(RequestKind::kHold).accepted);
  EXPECT_EQ(state(), MissionState::kAborted);
  fly_for(3.0);
  ASSERT_TRUE(ask(RequestKind::kMissionStart).accepted);
  EXPECT_EQ(item(), 0);
  ASSERT_TRUE(step_until([&] { return state() == MissionState::kCompleted; }, 20.0));
}

TEST_F(MissionFlight, RefusalsGiveTheReason) {
  EXPECT_STREQ(ask(RequestKind::kMissionStart).reason, "no mission is uploaded; upload one first");
  EXPECT_STREQ(pause().reason, "no mission is running");
  EXPECT_STREQ(resume().reason, "no mission is running");
  EXPECT_STREQ(ask(RequestKind::kMissionSkip).reason, "no mission is running");
  const Mission mission = mission_of({waypoint({1, 0, -1}), waypoint({0, 0, -1})});
  const Mission other = mission_of({waypoint({1, 1, -1})}, 8);
  ASSERT_TRUE(upload(mission).accepted);
  Request start;
  start.kind = RequestKind::kMissionStart;
  start.mission_id = 9;
  EXPECT_STREQ(supervisor_.request(start, inputs_).reason,
               "mission 9 is not uploaded; the uploaded mission is 7");
  start.mission_id = 7;
  ASSERT_TRUE(supervisor_.request(start, inputs_).accepted);
  EXPECT_STREQ(upload(other).reason, "mission 7 is running; end it with hold, goto or land");
  EXPECT_STREQ(ask(RequestKind::kMissionStart).reason,
               "mission 7 is running; end it with hold, goto or land");
  EXPECT_STREQ(ask(RequestKind::kMissionClear).reason,
               "mission 7 is running; end it with hold, goto or land");
  EXPECT_STREQ(resume().reason, "the mission is not paused");
  ASSERT_TRUE(pause().accepted);
  EXPECT_STREQ(pause().reason, "mission 7 is already paused");
  EXPECT_STREQ(upload(other).reason, "mission 7 is paused; resume or clear it");
  ASSERT_TRUE(ask(RequestKind::kMissionSkip).accepted);
  EXPECT_EQ(item(), 1);
  EXPECT_STREQ(ask(RequestKind::kMissionSkip).reason,
               "item 2 is the last of the mission; there is no item to skip to");
}

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

TEST_F(MissionFlight, AcceptanceRadiusWaitsForTheVehicle) {
  Mission mission = mission_of({waypoint({1, 0, -1}, 0.5, 1.0), waypoint({0, 0, -1})});
  mission.items[0].acceptance_radius_m = 0.05;
  ASSERT_TRUE(fly(mission).accepted);
  fly_for(2.0);
  follows_ = false;  // the vehicle is off the reference
  estimate_.position_ned = {0.9, 0, -1};
  fly_for(10.0);
  EXPECT_EQ(item(), 0);
  EXPECT_NEAR(control_setpoint_.reference.position_ned.x(), 1.0, 1e-9);
  estimate_.position_ned = {0.951, 0, -1};
  fly_for(0.9);
  EXPECT_EQ(item(), 0) << "the hold starts when the vehicle has arrived";
  fly_for(0.2);
  EXPECT_EQ(item(), 1);
}

TEST_F(MissionFlight, WaitHoldsThePosition) {
  MissionItem wait;
  wait.kind = MissionItemKind::kWait;
  wait.hold_s = 2.0;
  const Mission mission = mission_of({waypoint({0.5, 0, -1}), wait, waypoint({0, 0, -1})});
  ASSERT_TRUE(check(mission, Limits{}).accepted) << check(mission, Limits{}).reason;
  ASSERT_TRUE(fly(mission).accepted);
  ASSERT_TRUE(step_until([&] { return item() == 1; }, 10.0));
  const std::int64_t begun_ns = inputs_.stamp_ns;
  ASSERT_TRUE(step_until([&] { return item() == 2; }, 10.0));
  EXPECT_NEAR(static_cast<double>(inputs_.stamp_ns - begun_ns) * 1e-9, 2.0, 0.01);
  EXPECT_NEAR(estimate_.position_ned.x(), 0.5, 1e-4);
  EXPECT_TRUE(step_until([&] { return state() == MissionState::kCompleted; }, 10.0));
}

TEST_F(MissionFlight, FreeYawTrajectoryKeepsTheYaw) {
  Mission mission = mission_of({waypoint({0, 0, -1})});
  mission.items[0].yaw_free = false;
  mission.items[0].yaw_rad = 0.7;
  mission.segments = {minimum_jerk({0, 0, -1}, -1.0, {1, 0, -1}, 1.0, 4.0),
                      minimum_jerk({1, 0, -1}, 1.0, {0, 0, -1}, -1.0, 4.0)};
  for (const bool yaw_free : {true, false}) {
    mission.items.resize(1);
    mission.items.push_back({MissionItemKind::kTrajectory, Vector3d::Zero(), 0, yaw_free, 0.5, 0.0, 0, 2});
    ASSERT_TRUE(fly(mission).accepted);
    ASSERT_TRUE(step_until([&] { return item() == 1; }, 10.0));
    double least = 9.0;
    double greatest = -9.0;
    step_until(
        [&] {
          least = std::min(least, control_setpoint_.reference.yaw_rad);
          greatest = std::max(greatest, control_setpoint_.reference.yaw_rad);
          return state() == MissionState::kCompleted;
        },
        20.0);
    EXPECT_NEAR(least, yaw_free ? 0.7 : -1.0, 1e-3);
    EXPECT_NEAR(greatest, yaw_free ? 0.7 : 1.0, 1e-3);
  }
}

TEST_F(MissionFlight, MissionLimitsHoldDuringTheMission) {
  Mission mission = mission_of({waypoint({2, 0, -1}, 2.0)});
  const auto peaks = [&] {
    Vector3d peak = Vector3d::Zero();
    EXPECT_TRUE(fly(mission).accepted);
    step_until(
        [&] {
          peak = peak.cwiseMax(Vector3d(control_setpoint_.reference.velocity_ned.norm(),
                                        control_setpoint_.reference.acceleration_ned.norm(),
                                        control_setpoint_.reference.jerk_ned.norm()));
          return state() == MissionState::kCompleted;
        },
        60.0);
    EXPECT_TRUE(ask(RequestKind::kGoTo, {0, 0, -1}, 2.0).accepted);
    fly_for(10.0);
    return peak;
  };
  EXPECT_GT(peaks().y(), 1.5);
  mission.bounds.max_acceleration = 0.5;
  EXPECT_NEAR(peaks().y(), 0.5, 0.01);
  mission.bounds = {};
  mission.bounds.max_jerk = 1.0;
  EXPECT_NEAR(peaks().z(), 1.0, 0.01);
  mission.bounds = {};
  mission.bounds.max_speed = 1.0;
  EXPECT_FALSE(check(mission, Limits{}).accepted) << "its waypoint asks for 2 m/s";
}

TEST_F(MissionFlight, MissionFenceHoldsUntilTheMissionEnds) {
  Mission mission = mission_of({waypoint({1, 0, -1}), waypoint({0, 0, -1})});
  mission.bounds.fenced = true;
  mission.bounds.fence_min_ned = {-0.5, -0.5, -1.5};
  mission.bounds.fence_max_ned = {1.5, 0.5, 0.2};
  ASSERT_TRUE(check(mission, Limits{}).accepted) << check(mission, Limits{}).reason;
  ASSERT_TRUE(fly(mission).accepted);
  fly_for(1.0);
  ASSERT_TRUE(pause().accepted);
  fly_for(2.0);
  EXPECT_STREQ(ask(RequestKind::kGoTo, {0, 1, -1}).reason,
               "goto: y is 1.000 m, outside the fence of -0.500 to 0.500 m");
  ASSERT_TRUE(resume().accepted);
  follows_ = false;
  const Vector3d inside = estimate_.position_ned;
  estimate_.position_ned.y() = 0.71;
  step();
  EXPECT_EQ(supervisor_.mode(), Mode::kLanding);
  EXPECT_EQ(supervisor_.reason(), Reason::kOutsideFence);
  EXPECT_EQ(state(), MissionState::kAborted);
  estimate_.position_ned = inside;
  follows_ = true;
  ASSERT_TRUE(ask(RequestKind::kGoTo, {0, 1, -1}).accepted) << "the mission is over";
  fly_for(5.0);
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
}

TEST_F(MissionFlight, RefusesToStartOutsideTheMissionFence) {
  Mission mission = mission_of({waypoint({2, 0, -1})});
  mission.bounds.fenced = true;
  mission.bounds.fence_min_ned = {1, -1, -2};
  mission.bounds.fence_max_ned = {3, 1, 0.1};
  ASSERT_TRUE(upload(mission).accepted);
  EXPECT_STREQ(ask(RequestKind::kMissionStart).reason,
               "the vehicle: x is 0.000 m, outside the fence of 1.000 to 3.000 m");
}

// The vehicle hovers at 1 m inside a fence that ends 0.5 m above the ground.
TEST_F(MissionFlight, RefusesToStartIfItWouldLandOutsideTheMissionFence) {
  Mission mission =
      mission_of({waypoint({1, 0, -1}), {MissionItemKind::kLand, {0, 0, 0}, 0, true, 0.4, 0.0}});
  mission.bounds.fenced = true;
  mission.bounds.fence_min_ned = {-1, -1, -2};
  mission.bounds.fence_max_ned = {2, 1, -0.5};
  ASSERT_TRUE(upload(mission).accepted);
  EXPECT_STREQ(ask(RequestKind::kMissionStart).reason,
               "the landing point: z is 0.000 m, outside the fence of -2.000 to -0.500 m");
  mission.items.pop_back();
  EXPECT_TRUE(fly(mission).accepted) << "it does not land";
}

TEST(MissionBounds, AreTighterThanTheSettingsAndNotEmpty) {
  const Limits limits;
  const auto refusal = [&](const MissionBounds& bounds) { return std::string(check(bounds, limits).reason); };
  EXPECT_EQ(refusal({}), "");
  EXPECT_EQ(refusal({3.0}), "the mission's speed limit is 3.000 m/s, must be above 0 and at most 2.000 m/s");
  EXPECT_EQ(refusal({0.0, 9.0}),
            "the mission's acceleration limit is 9.000 m/s^2, must be above 0 and at most 5.000 m/s^2");
  EXPECT_EQ(refusal({0.0, 0.0, std::nan("")}),
            "the mission's jerk limit is nan m/s^3, must be above 0 and at most 8.000 m/s^3");
  EXPECT_EQ(refusal({0.0, 0.0, 0.0, 0.0, true, {-4, -1, -1}, {1, 1, 0}}),
            "the mission's fence, minimum corner: x is -4.000 m, outside the fence of -3.000 to 3.000 m");
  EXPECT_EQ(refusal({0.0, 0.0, 0.0, 0.0, true, {-1, 1, -1}, {1, 1, 0}}),
            "the mission's fence: maximum y is 1.000 m, must be above the minimum, 1.000 m");
}

TEST(MissionBounds, HoldForGivenTrajectories) {
  const Limits limits;
  Mission mission = curve();
  for (MissionItem& item : mission.items) item.yaw_free = false;
  ASSERT_TRUE(check(mission, limits).accepted) << check(mission, limits).reason;
  mission.bounds.max_jerk = 0.1;
  EXPECT_NE(std::string(check(mission, limits).reason).find("the limit is 0.10 m/s^3"), std::string::npos)
      << check(mission, limits).reason;
  mission.bounds = {};
  mission.bounds.max_speed = 0.5;
  EXPECT_NE(std::string(check(mission, limits).reason).find("the limit is 0.50 m/s"), std::string::npos)
      << check(mission, limits).reason;
  mission.bounds = {};
  mission.segments.front().yaw = {0.0, 0.9};
  mission.bounds.max_yaw_rate = 0.5;
  const char* const too_fast = "item 1: segment 1 reaches a yaw rate of 0.90 rad/s, the limit is 0.50 rad/s";
  EXPECT_STREQ(check(mission, limits).reason, too_fast);
  mission.segments.front().yaw = {0.0, -0.9};
  EXPECT_STREQ(check(mission, limits).reason, too_fast) << "to the left as to the right";
}

}  // namespace swiftlet::control::mission_test
