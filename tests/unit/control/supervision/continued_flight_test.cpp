// A supervisor that continues the flight of another from its state.
#include <gtest/gtest.h>

#include "swiftlet/control/supervision/supervisor.hpp"
#include "tests/unit/control/supervision/flight_fixture.hpp"

namespace swiftlet::control::continued_flight_test {

using Eigen::Vector3d;

class ContinuedFlight : public tests::FlightTest {};

bool same(const ControlSetpoint& a, const ControlSetpoint& b) {
  return a.control_mode == b.control_mode && a.lift_fraction == b.lift_fraction &&
         a.integrate == b.integrate && a.reference.position_ned == b.reference.position_ned &&
         a.reference.velocity_ned == b.reference.velocity_ned &&
         a.reference.acceleration_ned == b.reference.acceleration_ned &&
         a.reference.jerk_ned == b.reference.jerk_ned && a.reference.snap_ned == b.reference.snap_ned &&
         a.reference.yaw_rad == b.reference.yaw_rad && a.reference.yaw_rate == b.reference.yaw_rate;
}

TEST_F(ContinuedFlight, FollowerContinuesFromItsStateAtEveryStep) {
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

TEST_F(ContinuedFlight, FailoverWithAnUnknownMissionHolds) {
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

}  // namespace swiftlet::control::continued_flight_test
