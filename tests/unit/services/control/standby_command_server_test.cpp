// A standby controller: it follows the state of the active one, and continues its flight.
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/malloc_guard.hpp"
#include "tests/unit/services/control/command_server_fixture.hpp"

namespace swiftlet::services::standby_command_server_test {

// A standby that receives the same samples as the fixture's controller.
class StandbyCommandServerTest : public CommandServerTest {
 protected:
  StandbyCommandServerTest()
      : standby_loop_(vehicle_, settings_),
        standby_server_(standby_loop_, vehicle_, settings_, GainDesigner(vehicle_, settings_), wake_) {
    standby_server_.set_active(false);
  }
  static constexpr std::uint32_t kTerm = 7;

  // Passes the report of the active controller to the standby.
  void pass_state_to_standby(std::uint32_t term = kTerm) {
    messages::ControllerReport report;
    loop_.report(report);
    ASSERT_TRUE(report.active);
    messages::ControllerReport received;
    ASSERT_FALSE(messages::from_message(messages::to_message(report), received));
    FailoverState failover_state;
    failover_state.term = term;
    failover_state.flight = received.flight;
    standby_server_.follow(failover_state);
  }
  plant::ActuatorCommand step_standby(Role role) {
    standby_loop_.pose.put(last_pose_);
    standby_loop_.battery.put(last_battery_);
    standby_loop_.rotor_speeds.put(last_rotor_speeds_);
    const std::int64_t now_ns = 1'000'000'000 + last_imu_.stamp_ns;
    const auto command = std::get<plant::ActuatorCommand>(standby_loop_.step(last_imu_, now_ns, role, kTerm));
    standby_loop_.finish(now_ns + 20'000);
    return command;
  }
  void fly_mission() {
    settle();
    follows_reference_ = true;
    command_server_.on_command(command(Command_Constants::ARM, 1));
    step();
    command_server_.on_mission(mission(2, 1.0));
    command_server_.on_command(command(Command_Constants::MISSION_START, 3));
    step();
    command_server_.collect();
  }
  void follow(int steps) {
    for (int i = 0; i < steps; ++i) {
      step();
      pass_state_to_standby();
      step_standby(Role::kStandby);
    }
  }
  control::SupervisorState standby_state() {
    messages::ControllerReport report;
    standby_loop_.step(last_imu_, 0, Role::kActive);
    standby_loop_.report(report);
    return report.flight.supervisor;
  }

  InnerLoop standby_loop_;
  CommandServer standby_server_;
};

TEST_F(StandbyCommandServerTest, AnswersNoRequests) {
  settle();
  standby_server_.on_command(command(Command_Constants::ARM, 1));
  step();
  step_standby(Role::kStandby);
  EXPECT_TRUE(standby_server_.collect().empty());
  EXPECT_EQ(standby_state().mode, control::Mode::kDisarmed);
}

// Setpoints reach all controllers, but only the active one evaluates them and reports refusals.
TEST_F(StandbyCommandServerTest, IgnoresSetpoints) {
  settle();
  const control::Setpoint setpoint;  // is refused on the ground
  const auto tally = [&] {
    Snapshot snapshot;
    SetpointTally newest;
    while (standby_loop_.snapshots.pop(snapshot)) newest = snapshot.setpoints;
    return newest;
  };
  for (int i = 0; i < 20; ++i) {
    step();
    standby_loop_.setpoint.put(setpoint);
    step_standby(Role::kStandby);
  }
  EXPECT_EQ(tally().refused, 0U);
  for (int i = 0; i < 20; ++i) {
    step();
    standby_loop_.setpoint.put(setpoint);
    step_standby(Role::kActive);
  }
  const SetpointTally active = tally();
  EXPECT_GT(active.refused, 10U) << "the active controller must count them";
  EXPECT_NE(std::string(active.refusal.reason), "");
}

// A controller that was replaced may still send its state for a moment.
TEST_F(StandbyCommandServerTest, FollowsOnlyTheControllerOfTheTermItFollows) {
  settle();
  follow(20);
  command_server_.on_command(command(Command_Constants::ARM, 1));
  step();
  ASSERT_EQ(mode(), control::Mode::kArmed);
  for (const std::uint32_t other_term : {kTerm - 1, kTerm + 1}) {
    pass_state_to_standby(other_term);
    step_standby(Role::kStandby);
    EXPECT_EQ(standby_state().mode, control::Mode::kDisarmed) << other_term;
  }
  pass_state_to_standby();
  step_standby(Role::kStandby);
  EXPECT_EQ(standby_state().mode, control::Mode::kArmed);
}

// GIVEN a standby that follows a mission WHEN a controller of another term tells of its own flight, and more missions
// arrive than the standby stores THEN it keeps the mission that its inner loop flies.
TEST_F(StandbyCommandServerTest, KeepsTheMissionThatItFollows) {
  fly_mission();
  standby_server_.on_mission(mission(2, 1.0));
  follow(20);
  FailoverState rival;
  rival.term = kTerm + 1;
  standby_server_.follow(rival);
  step_standby(Role::kStandby);
  for (std::uint64_t id = 11; id <= 15; ++id) standby_server_.on_flown_mission(mission(id, 1.0));
  standby_server_.collect();
  EXPECT_EQ(standby_server_.mission(2).id(), 2U);
  for (int i = 0; i < 1500; ++i) {  // into the next item of the mission
    step();
    step_standby(Role::kStandby);
  }
}

TEST_F(StandbyCommandServerTest, ContinuesAMissionKnownFromItsUpload) {
  fly_mission();
  standby_server_.on_mission(mission(2, 1.0));
  follow(20);  // until the standby has a pose
  for (int i = 0; i < 1500; ++i) {
    const plant::ActuatorCommand flown = step();
    pass_state_to_standby();
    const plant::ActuatorCommand followed = step_standby(Role::kStandby);
    EXPECT_EQ(followed.rotor_state, flown.rotor_state);
  }
  ASSERT_EQ(mode(), control::Mode::kMission);
  messages::ControllerReport active;
  loop_.report(active);
  const control::SupervisorState state = standby_state();
  EXPECT_EQ(state.mode, control::Mode::kMission);
  EXPECT_EQ(state.guidance.mission.id, 2U);
  EXPECT_EQ(state.guidance.phase, active.flight.supervisor.guidance.phase);
  for (std::size_t i = 0; i < control::kPolynomialCoefficients; ++i)
    EXPECT_FLOAT_EQ(static_cast<float>(state.guidance.path.segment.z[i]),
                    static_cast<float>(active.flight.supervisor.guidance.path.segment.z[i]));
  EXPECT_TRUE(standby_server_.collect().empty());
}

TEST_F(StandbyCommandServerTest, ContinuesAMissionKnownFromTheActiveController) {
  fly_mission();
  standby_server_.on_flown_mission(command_server_.mission(2));
  follow(20);
  EXPECT_EQ(standby_state().mode, control::Mode::kMission);
}

// GIVEN an uploaded mission WHEN a standby takes over THEN it can start the mission.
TEST_F(StandbyCommandServerTest, StartsAMissionUploadedBeforeTheFailover) {
  for (const bool upload_received : {true, false}) {
    SCOPED_TRACE(upload_received);
    settle();
    const std::uint64_t id = upload_received ? 12 : 22;
    command_server_.on_command(command(Command_Constants::ARM, id - 1));
    command_server_.on_mission(mission(id, 1.0));
    step();
    command_server_.collect();
    if (upload_received) {
      standby_server_.on_mission(mission(id, 1.0));
    } else {
      standby_server_.on_flown_mission(command_server_.mission(id));
    }
    follow(20);
    control::SupervisorState state = standby_state();
    EXPECT_EQ(state.guidance.mission.id, id);
    EXPECT_EQ(state.guidance.mission.state, control::MissionState::kUploaded);
    EXPECT_EQ(state.guidance.mission.item_count, 3);
    standby_server_.set_active(true);
    standby_server_.on_command(command(Command_Constants::MISSION_START, id + 1));
    step();
    step_standby(Role::kActive);
    const std::vector<messages::msg::CommandAck> answers = standby_server_.collect();
    ASSERT_EQ(answers.size(), 1U);
    EXPECT_TRUE(answers[0].accepted()) << answers[0].reason();
    state = standby_state();
    EXPECT_EQ(state.mode, control::Mode::kMission);
    EXPECT_EQ(state.guidance.mission.state, control::MissionState::kRunning);
    standby_server_.set_active(false);
    command_server_.on_command(command(Command_Constants::DISARM, id + 2));
    step();
    command_server_.collect();
  }
}

TEST_F(StandbyCommandServerTest, StaysDisarmedWithoutTheMission) {
  fly_mission();
  follow(20);
  const control::SupervisorState state = standby_state();
  EXPECT_EQ(state.mode, control::Mode::kDisarmed);
  EXPECT_EQ(state.reason, control::Reason::kPlanUnknown);
}

// GIVEN an accepted request WHEN the controller dies before its answer arrives THEN the new controller
// answers it and does not apply it again.
TEST_F(StandbyCommandServerTest, AnswersARequestAcceptedBeforeTheFailover) {
  settle();
  command_server_.on_command(command(Command_Constants::ARM, 1));
  step();
  pass_state_to_standby();
  step_standby(Role::kStandby);

  standby_server_.set_active(true);
  step_standby(Role::kActive);
  standby_server_.on_command(command(Command_Constants::DISARM, 2));
  standby_server_.on_command(command(Command_Constants::ARM, 1));
  step();
  step_standby(Role::kActive);

  const std::vector<messages::msg::CommandAck> answers = standby_server_.collect();
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].id(), 1U);
  EXPECT_TRUE(answers[0].accepted());
  EXPECT_EQ(answers[1].id(), 2U);
  EXPECT_EQ(standby_state().mode, control::Mode::kDisarmed);
}

// GIVEN an executing mission WHEN a standby takes over THEN it reports the request as executing, and as
// canceled after a newer request.
TEST_F(StandbyCommandServerTest, ContinuesTheExecutingRequest) {
  standby_server_.on_mission(mission(2, 1.0));
  fly_mission();
  follow(600);
  const control::RequestStatus before = standby_state().requests.back();
  EXPECT_EQ(before.key, (control::RequestKey{kClient, 3}));
  EXPECT_EQ(before.state, control::RequestState::kExecuting);

  standby_server_.set_active(true);
  standby_server_.on_command(command(Command_Constants::STOP, 4));
  step();
  step_standby(Role::kActive);
  const control::RequestStatuses after_stop = standby_state().requests;
  EXPECT_EQ(after_stop[after_stop.size() - 2].key, before.key);
  EXPECT_EQ(result_of(after_stop[after_stop.size() - 2]), "canceled by a newer request: stop");
  EXPECT_EQ(after_stop.back().state, control::RequestState::kSucceeded);
}

TEST_F(StandbyCommandServerTest, FollowingDoesNotAllocate) {
  fly_mission();
  standby_server_.on_mission(mission(2, 1.0));
  std::size_t calls = 0;
  for (int i = 0; i < 50; ++i) {
    step();
    pass_state_to_standby();
    const test::MallocGuard guard;
    step_standby(Role::kStandby);
    calls += guard.calls();
  }
  EXPECT_EQ(calls, 0U);
}

}  // namespace swiftlet::services::standby_command_server_test
