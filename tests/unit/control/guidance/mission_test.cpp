// Upload, start, skip and clear of missions, and the bounds that they set.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "tests/unit/control/guidance/mission_flight.hpp"

namespace swiftlet::control::mission_test {

using namespace mission_flight;

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
  mission.bounds.max_yaw_rate = 0.5;
  const double t = mission.segments.front().duration_s;
  for (const double rate : {0.9, -0.9}) {  // in the middle, from and to rest
    mission.segments.front().yaw = {0.0, 0.0, 2.0 * rate / t, -4.0 / 3.0 * rate / (t * t)};
    EXPECT_STREQ(check(mission, limits).reason,
                 "item 1: segment 1 reaches a yaw rate of 0.90 rad/s, the limit is 0.50 rad/s");
  }
}

// Before and after a trajectory the vehicle stands in the air.
TEST(TrajectoryCheck, GoesFromRestToRest) {
  const Limits limits;
  Trajectory trajectory;
  trajectory.segments = {{2.0, {}, {}, {-1.0}, {}}};
  const auto refusal = [&] { return std::string(check(trajectory, limits).reason); };
  EXPECT_EQ(refusal(), "");
  PolynomialSegment& only = trajectory.segments.front();
  only.x = {0.0, 0.0, 0.375, -0.09375};  // 0.375 m/s at its end
  EXPECT_EQ(refusal(), "the trajectory ends at 0.38 m/s, must end at rest");
  only.x = {0.0, 0.5};
  EXPECT_EQ(refusal(), "the trajectory starts at 0.50 m/s, must start at rest");
  only.x = {};
  only.yaw = {0.0, 0.0, 0.25};
  EXPECT_EQ(refusal(), "the trajectory ends turning at 1.00 rad/s, must end at rest");
  only.yaw = {0.0, 0.5};
  EXPECT_EQ(refusal(), "the trajectory starts turning at 0.50 rad/s, must start at rest");
}

}  // namespace swiftlet::control::mission_test
