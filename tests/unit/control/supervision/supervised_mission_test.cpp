// Missions: their items, their end, and what interrupts them.
#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/supervision/supervisor.hpp"
#include "tests/unit/control/supervision/flight_fixture.hpp"

namespace swiftlet::control::supervised_mission_test {

using Eigen::Vector3d;

class SupervisedMission : public tests::FlightTest {};

TEST_F(SupervisedMission, FliesTheItemsOfAMissionInOrderAndCompletesIt) {
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

TEST_F(SupervisedMission, AbortsAnInterruptedMission) {
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

// A mission that has lifted off, but does not climb yet, cannot be paused: it would not climb.
TEST_F(SupervisedMission, PausesNoMissionThatRisesFromTheGround) {
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

}  // namespace swiftlet::control::supervised_mission_test
