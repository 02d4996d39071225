// Missions that start at a given time: on the ground with idling rotors until then, or from rest in the air.
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/control/supervision/supervised_flight.hpp"

namespace swiftlet::control::mission_start_time_test {

constexpr double kSpoolUp_s = 0.8;

Mission hop() {
  Mission mission;
  mission.id = 7;
  mission.items = {{MissionItemKind::kTakeoff, {0, 0, -1}, 0.0, true, 0.5, 0.0},
                   {MissionItemKind::kWaypoint, {1, 0, -1}, 0.0, true, 0.5, 0.0}};
  return mission;
}

class MissionStartTime : public testing::Test, protected tests::SupervisedFlight {
 protected:
  Outcome start_in(double s, std::int64_t off_the_grid_ns = 0) {
    Request request = next_request(RequestKind::kMissionStart);
    request.start_ns = start_ns_ = inputs_.stamp_ns + std::llround(s * 1e9) + off_the_grid_ns;
    return supervisor_.request(request, inputs_);
  }
  std::int64_t start_ns_ = 0;
  Mission mission_ = hop();
};

TEST_F(MissionStartTime, IdlesOnTheGroundAndClimbsAtTheTimeToTheNanosecond) {
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(upload(mission_).accepted);
  ASSERT_TRUE(start_in(1.0, 700'000).accepted);  // between two samples
  while (inputs_.stamp_ns + kStep_ns < start_ns_) {
    step();
    ASSERT_EQ(control_setpoint_.control_mode, ControlMode::kIdle);
  }
  step();
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kSpoolUp);
  ASSERT_TRUE(step_until([&] { return control_setpoint_.control_mode == ControlMode::kFly; }, 2.0));
  EXPECT_EQ(supervisor_.state().guidance.path.start_ns, start_ns_ + std::llround(kSpoolUp_s * 1e9));
  EXPECT_TRUE(step_until([&] { return supervisor_.mission().state == MissionState::kCompleted; }, 30.0));
}

TEST_F(MissionStartTime, StartsFromRestInTheAirOnly) {
  ASSERT_TRUE(take_off());
  ASSERT_TRUE(upload(mission_).accepted);
  ASSERT_TRUE(ask(RequestKind::kGoTo, {0.5, 0, -1}).accepted);
  const Outcome moving = start_in(1.0);
  EXPECT_FALSE(moving.accepted);
  EXPECT_EQ(std::string(moving.reason),
            "mission start: the vehicle still moves; at a given time it can start from rest only");
  ASSERT_TRUE(step_until([&] { return supervisor_.state().guidance.path.finished(inputs_.stamp_ns); }, 20.0));
  ASSERT_TRUE(start_in(1.0).accepted);
  while (inputs_.stamp_ns + kStep_ns < start_ns_) {
    step();
    ASSERT_LT((control_setpoint_.reference.position_ned - Eigen::Vector3d(0.5, 0, -1)).norm(), 1e-9);
  }
  EXPECT_EQ(supervisor_.state().guidance.path.start_ns, start_ns_);
}

// The reference of a landing sinks on for a minute; the touchdown comes before.
TEST_F(MissionStartTime, StartsAgainAfterALanding) {
  mission_.items.back() = {MissionItemKind::kLand, {0, 0, 0}, 0.0, true, 0.4, 0.0};
  for (int flight = 0; flight < 2; ++flight) {
    ASSERT_TRUE(ask(RequestKind::kArm).accepted);
    ASSERT_TRUE(upload(mission_).accepted);
    const Outcome start = start_in(1.0, 700'000);
    ASSERT_TRUE(start.accepted) << start.reason;
    ASSERT_TRUE(step_until([&] { return control_setpoint_.control_mode == ControlMode::kFly; }, 3.0));
    EXPECT_EQ(supervisor_.state().guidance.path.start_ns, start_ns_ + std::llround(kSpoolUp_s * 1e9));
    ASSERT_TRUE(step_until(Mode::kDisarmed, 30.0));
    ASSERT_EQ(supervisor_.mission().state, MissionState::kCompleted);
  }
}

TEST_F(MissionStartTime, RefusesThePastAndTheFarFuture) {
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(upload(mission_).accepted);
  EXPECT_EQ(std::string(start_in(-0.01).reason), "mission start: the start time was 0.010 s ago");
  EXPECT_EQ(std::string(start_in(61.0).reason),
            "mission start: the start time is 61.0 s ahead, the limit is 60 s");
  EXPECT_EQ(supervisor_.mode(), Mode::kArmed);
}

TEST_F(MissionStartTime, IsTakenBackByDisarmAndByLand) {
  for (const RequestKind kind : {RequestKind::kDisarm, RequestKind::kLand}) {
    ASSERT_TRUE(ask(RequestKind::kArm).accepted);
    ASSERT_TRUE(upload(mission_).accepted);
    ASSERT_TRUE(start_in(1.0).accepted);
    step();
    ASSERT_TRUE(ask(kind).accepted);
    EXPECT_EQ(supervisor_.mode(), Mode::kDisarmed);
    EXPECT_EQ(supervisor_.mission().state, MissionState::kAborted);
  }
}

}  // namespace swiftlet::control::mission_start_time_test
