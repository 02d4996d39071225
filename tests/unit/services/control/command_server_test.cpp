// Requests through the command server and the inner loop, and the allocations of the inner loop.
#include "swiftlet/services/control/command_server.hpp"

#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/control/inner_loop.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/malloc_guard.hpp"

namespace swiftlet::services {
namespace {

namespace msg = comms::msg;
namespace Command_Constants = comms::msg::Command_Constants;
using namespace std::chrono_literals;

constexpr std::uint64_t kClient = 77;

class CommandServerTest : public testing::Test {
 protected:
  CommandServerTest()
      : vehicle_(runtime::load_vehicle(SWIFTLET_SOURCE_DIR "/config/vehicles/kaylion.yaml")),
        settings_(runtime::load_control_settings(SWIFTLET_SOURCE_DIR "/config/control/motor_lag.yaml")),
        loop_(vehicle_, settings_),
        command_server_(loop_, settings_.limits, GainDesigner(vehicle_, settings_), wake_) {}

  // The vehicle at rest on the ground: one IMU, battery and rotor speed sample, and a pose with every fifth.
  plant::ActuatorCommand step() {
    ++sequence_;
    const auto stamp = static_cast<std::int64_t>(sequence_) * 2'000'000;
    if (sequence_ % 5 == 1) {
      last_pose_.stamp_ns = stamp;
      last_pose_.sequence = sequence_;
      last_pose_.tracked = true;
      loop_.pose.put(last_pose_);
    }
    last_battery_ = {stamp, sequence_, 4.0, 0.1, 0.9};
    loop_.battery.put(last_battery_);
    last_rotor_speeds_.stamp_ns = stamp;
    last_rotor_speeds_.sequence = sequence_;
    last_rotor_speeds_.rotor_count = vehicle_.rotor_count();
    loop_.rotor_speeds.put(last_rotor_speeds_);
    last_imu_.stamp_ns = stamp;
    last_imu_.sequence = sequence_;
    last_imu_.specific_force_frd = {0.0, 0.0, -plant::kGravity};
    const plant::ActuatorCommand command = loop_.step(last_imu_, 1'000'000'000 + stamp);
    loop_.finish(1'000'000'000 + stamp + 20'000);
    return command;
  }
  void settle() {
    for (int i = 0; i < 500; ++i) step();
    Snapshot snapshot;
    while (loop_.snapshots.pop(snapshot)) last_ = snapshot;
  }
  control::Mode mode() {
    step();
    Snapshot snapshot;
    while (loop_.snapshots.pop(snapshot)) last_ = snapshot;
    return last_.status.mode;
  }

  static msg::Command command(std::uint8_t kind, std::uint64_t id) {
    msg::Command message;
    message.client(kClient);
    message.id(id);
    message.kind(kind);
    message.speed(0.5);
    message.position_ned({0.0, 0.0, -1.0});
    return message;
  }
  static msg::Mission mission(std::uint64_t id, double x) {
    control::Mission mission;
    mission.id = id;
    mission.items.push_back({control::MissionItemKind::kTakeoff, {0.0, 0.0, -1.0}, 0.0, true, 0.5, 0.0});
    mission.items.push_back({control::MissionItemKind::kWaypoint, {x, 0.0, -1.0}, 0.0, true, 0.5, 0.0});
    mission.items.push_back({control::MissionItemKind::kLand, {0.0, 0.0, 0.0}, 0.0, true, 0.5, 0.0});
    msg::Mission message = comms::to_message(mission);
    message.client(kClient);
    return message;
  }

  // The settings of the controller with another bandwidth of x.
  msg::ControlSettings settings_message(std::uint64_t id, double omega_n, double zeta = 1.0) const {
    control::ControlSettings settings = settings_;
    settings.name = "soft";
    settings.position.x.omega_n = omega_n;
    settings.position.x.zeta = zeta;
    msg::ControlSettings message = comms::to_message(control::settings_request(settings, {}, 1.0));
    message.client(kClient);
    message.id(id);
    return message;
  }

  plant::Vehicle vehicle_;
  control::ControlSettings settings_;
  runtime::Semaphore wake_;
  InnerLoop loop_;
  CommandServer command_server_;
  std::uint64_t sequence_ = 0;
  plant::PoseSample last_pose_;
  plant::BatterySample last_battery_;
  plant::RotorSpeedSample last_rotor_speeds_;
  plant::ImuSample last_imu_;
  Snapshot last_;
};

TEST_F(CommandServerTest, AnswersARequestInTheNextStep) {
  settle();
  command_server_.on_command(command(Command_Constants::ARM, 1));
  EXPECT_TRUE(command_server_.collect().empty());

  EXPECT_EQ(step().rotor_state, plant::RotorState::kRunning);

  const std::vector<RequestResult> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].client, kClient);
  EXPECT_EQ(answers[0].id, 1U);
  EXPECT_STREQ(answers[0].kind, "arm");
  EXPECT_TRUE(answers[0].outcome.accepted) << answers[0].outcome.reason;
  EXPECT_FALSE(answers[0].repeated);
  EXPECT_EQ(mode(), control::Mode::kArmed);
}

// GIVEN a request that a step accepts, THEN the answer has the stamp of its sample, and every status from then on
// lists the request.
TEST_F(CommandServerTest, StatusesAfterAnAcceptanceIncludeTheRequest) {
  settle();
  command_server_.on_command(command(Command_Constants::ARM, 1));
  step();
  command_server_.on_command(command(Command_Constants::TAKEOFF, 2));
  step();
  const std::int64_t accepted_ns = last_imu_.stamp_ns;
  for (const RequestResult& answer : command_server_.collect()) EXPECT_GT(answer.stamp_ns, 0) << answer.kind;
  command_server_.on_command(command(Command_Constants::TAKEOFF, 2));
  const std::vector<RequestResult> again = command_server_.collect();
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0].stamp_ns, accepted_ns);
  for (int i = 0; i < 20; ++i) step();
  int reported = 0;
  Snapshot snapshot;
  while (loop_.snapshots.pop(snapshot)) {
    if (snapshot.stamp_ns < accepted_ns) continue;
    ++reported;
    EXPECT_EQ(snapshot.requests.back().key, (control::RequestKey{kClient, 2})) << snapshot.stamp_ns;
  }
  EXPECT_GT(reported, 2);
}

// GIVEN a request for other settings THEN their gains are designed before the step, which takes them over.
TEST_F(CommandServerTest, ChangesTheGains) {
  settle();
  EXPECT_DOUBLE_EQ(last_.gains.position_p.x(), 5.6);
  command_server_.on_control_settings(settings_message(1, 1.0));
  step();
  std::vector<RequestResult> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_STREQ(answers[0].kind, "set control");
  EXPECT_TRUE(answers[0].outcome.accepted) << answers[0].outcome.reason;
  mode();
  EXPECT_DOUBLE_EQ(last_.gains.position_p.x(), 1.8);
  EXPECT_STREQ(last_.status.settings.data(), "soft");

  // The next change begins at these gains.
  command_server_.on_control_settings(settings_message(2, 2.0));
  step();
  EXPECT_STREQ(command_server_.collect().at(0).outcome.reason,
               "another request changed the gains meanwhile; send this one again");
  command_server_.set_gains_in_force(last_.gains);
  command_server_.on_control_settings(settings_message(3, 2.0));
  step();
  answers = command_server_.collect();
  EXPECT_TRUE(answers.at(0).outcome.accepted) << answers[0].outcome.reason;
}

TEST_F(CommandServerTest, RefusesUnstableGainsBeforeTheInnerLoop) {
  command_server_.on_control_settings(settings_message(1, 6.0, 0.2));
  const std::vector<RequestResult> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U) << "without a step";
  EXPECT_STREQ(answers[0].outcome.reason, "position.x: with the rotor lag the loop is unstable");
}

TEST_F(CommandServerTest, AnswersARefusalWithItsReason) {
  settle();
  command_server_.on_command(command(Command_Constants::LAND, 1));
  step();
  const std::vector<RequestResult> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_FALSE(answers[0].outcome.accepted);
  EXPECT_GT(std::string(answers[0].outcome.reason).size(), 0U);
}

TEST_F(CommandServerTest, AnswersARepeatedRequestWithoutApplyingItAgain) {
  settle();
  command_server_.on_command(command(Command_Constants::ARM, 1));
  step();
  ASSERT_EQ(command_server_.collect().size(), 1U);
  command_server_.on_command(command(Command_Constants::DISARM, 2));
  step();
  ASSERT_EQ(command_server_.collect().size(), 1U);
  ASSERT_EQ(mode(), control::Mode::kDisarmed);

  command_server_.on_command(command(Command_Constants::ARM, 1));  // repeated by the network

  EXPECT_EQ(step().rotor_state, plant::RotorState::kOff);
  const std::vector<RequestResult> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].id, 1U);
  EXPECT_TRUE(answers[0].outcome.accepted);
  EXPECT_TRUE(answers[0].repeated);
  EXPECT_EQ(mode(), control::Mode::kDisarmed);
}

TEST_F(CommandServerTest, IgnoresRepetitionsOfAPendingRequest) {
  settle();
  for (int i = 0; i < 3; ++i) command_server_.on_command(command(Command_Constants::ARM, 1));
  step();
  EXPECT_EQ(command_server_.collect().size(), 1U);
}

TEST_F(CommandServerTest, DistinguishesEqualIdsOfDifferentClients) {
  settle();
  command_server_.on_command(command(Command_Constants::ARM, 1));
  msg::Command other = command(Command_Constants::DISARM, 1);
  other.client(kClient + 1);
  command_server_.on_command(other);
  step();
  EXPECT_EQ(command_server_.collect().size(), 2U);
  EXPECT_EQ(mode(), control::Mode::kDisarmed);
}

TEST_F(CommandServerTest, RefusesInvalidRequestsBeforeTheInnerLoop) {
  msg::Command go = command(Command_Constants::GOTO, 1);
  go.position_ned()[1] = std::numeric_limits<double>::quiet_NaN();
  command_server_.on_command(go);
  msg::Mission outside = mission(2, 99.0);
  command_server_.on_mission(outside);
  msg::Mission broken = mission(3, 1.0);
  broken.items()[1].speed(std::numeric_limits<double>::quiet_NaN());
  command_server_.on_mission(broken);
  msg::Trajectory empty;
  empty.client(kClient);
  empty.id(4);
  command_server_.on_trajectory(empty);

  const std::vector<RequestResult> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 4U);
  for (const RequestResult& answer : answers) EXPECT_FALSE(answer.outcome.accepted);
  EXPECT_STREQ(answers[0].outcome.reason, "position_ned[1] is nan, must be finite");
  EXPECT_NE(std::string(answers[1].outcome.reason).find("item 2: x is 99.000 m"), std::string::npos);
  EXPECT_STREQ(answers[2].outcome.reason, "item 2: speed is nan, must be finite");
  EXPECT_STREQ(answers[3].outcome.reason, "the trajectory has no segments");
  EXPECT_EQ(loop_.requests.read_available(), 0U);
}

TEST_F(CommandServerTest, KeepsItsOwnCopyOfAMission) {
  settle();
  command_server_.on_command(command(Command_Constants::ARM, 1));
  step();
  {
    const msg::Mission message = mission(2, 1.0);
    command_server_.on_mission(message);
  }
  command_server_.on_command(command(Command_Constants::MISSION_START, 3));
  step();
  const std::vector<RequestResult> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 3U);
  ASSERT_TRUE(answers[1].outcome.accepted) << answers[1].outcome.reason;
  ASSERT_TRUE(answers[2].outcome.accepted) << answers[2].outcome.reason;
  for (int i = 0; i < 100; ++i) step();
  EXPECT_EQ(mode(), control::Mode::kMission);
  EXPECT_EQ(last_.status.mission.id, 2U);
  EXPECT_EQ(last_.status.mission.item_count, 3);
}

TEST_F(CommandServerTest, RefusesRequestsWithoutImuSamples) {
  settle();
  command_server_.on_command(command(Command_Constants::ARM, 1));
  std::vector<RequestResult> answers;
  ASSERT_TRUE(tests::eventually([&] {
    answers = command_server_.collect();
    return !answers.empty();
  }));
  EXPECT_FALSE(answers[0].outcome.accepted);
  EXPECT_STREQ(answers[0].outcome.reason, "no IMU samples arrive: is the vehicle running?");

  EXPECT_EQ(step().rotor_state, plant::RotorState::kOff);
  EXPECT_TRUE(command_server_.collect().empty());
  EXPECT_EQ(mode(), control::Mode::kDisarmed);
}

TEST_F(CommandServerTest, RefusesRequestsBeyondItsCapacity) {
  for (std::uint64_t id = 1; id <= kMaxPendingRequests; ++id)
    command_server_.on_command(command(Command_Constants::HOLD, id));
  const std::vector<RequestResult> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].id, static_cast<std::uint64_t>(kMaxPendingRequests));
  EXPECT_STREQ(answers[0].outcome.reason, "31 requests are pending, the limit");
  step();
  EXPECT_EQ(command_server_.collect().size(), static_cast<std::size_t>(kMaxPendingRequests) - 1);
}

TEST_F(CommandServerTest, AcceptsAStopWithoutImuSamples) {
  settle();
  command_server_.on_command(command(Command_Constants::ARM, 1));
  step();
  command_server_.collect();
  ASSERT_FALSE(command_server_.accept_overdue_stop(3.2, 7)) << "no stop was requested";

  command_server_.on_command(command(Command_Constants::STOP, 2));
  EXPECT_TRUE(command_server_.accept_overdue_stop(3.2, 7)) << "rotors off must be commanded";
  const std::vector<RequestResult> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_TRUE(answers[0].outcome.accepted);
  EXPECT_EQ(answers[0].stamp_ns, 7);
  EXPECT_STREQ(
      answers[0].outcome.reason,
      "rotors off is commanded, but the vehicle has been silent for 3.2 s (no IMU sample): it cannot confirm "
      "the stop");
  EXPECT_EQ(command_server_.accept_overdue_stop(3.3, 7)->id, 2U) << "until a sample comes";
  EXPECT_TRUE(command_server_.collect().empty()) << "answered once";

  EXPECT_EQ(step().rotor_state, plant::RotorState::kOff) << "the next sample executes it";
  EXPECT_TRUE(command_server_.collect().empty());
  EXPECT_FALSE(command_server_.accept_overdue_stop(0.0, 7));
  EXPECT_EQ(mode(), control::Mode::kStopped);
}

TEST_F(CommandServerTest, AcceptsAStopBesideAnyNumberOfRequests) {
  for (std::uint64_t id = 1; id <= 2 * kMaxPendingRequests; ++id)
    command_server_.on_command(command(Command_Constants::HOLD, id));
  command_server_.collect();
  for (const std::uint64_t id : {1001U, 1002U, 1003U})
    command_server_.on_command(command(Command_Constants::STOP, id));
  EXPECT_TRUE(command_server_.accept_overdue_stop(-1.0, 0));
  const std::vector<RequestResult> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 3U);
  for (const RequestResult& answer : answers) EXPECT_TRUE(answer.outcome.accepted) << answer.id;
}

TEST_F(CommandServerTest, LetsTheInnerLoopAnswerAStopWhileSamplesArrive) {
  settle();
  command_server_.on_command(command(Command_Constants::STOP, 1));
  EXPECT_FALSE(command_server_.accept_overdue_stop(0.002, 7));
  step();
  const std::vector<RequestResult> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_TRUE(answers[0].outcome.accepted);
  EXPECT_STREQ(answers[0].outcome.reason, "");
}

TEST_F(CommandServerTest, SamplesTelemetryAt100HzOfImuTime) {
  settle();
  std::size_t sampled = 0;
  for (int i = 0; i < 500; ++i) {
    step();
    Snapshot snapshot;
    while (loop_.snapshots.pop(snapshot)) {
      if (!snapshot.sampled) continue;
      ++sampled;
      EXPECT_EQ(snapshot.stamp_ns % 10'000'000, 0);
      EXPECT_EQ(snapshot.estimate.stamp_ns, snapshot.stamp_ns);
    }
  }
  EXPECT_EQ(sampled, 100U);
}

TEST_F(CommandServerTest, InnerLoopDoesNotAllocate) {
  settle();
  command_server_.on_command(command(Command_Constants::ARM, 1));
  command_server_.on_control_settings(settings_message(4, 1.0));
  command_server_.on_mission(mission(2, 1.0));
  command_server_.on_command(command(Command_Constants::MISSION_START, 3));
  std::size_t calls = 0;
  {
    const test::MallocGuard guard;
    for (int i = 0; i < 1000; ++i) step();
    calls = guard.calls();
  }
  EXPECT_EQ(calls, 0U);
  EXPECT_EQ(command_server_.collect().size(), 4U);
}

// A standby that receives the same samples as the fixture's controller.
class StandbyCommandServerTest : public CommandServerTest {
 protected:
  StandbyCommandServerTest()
      : standby_loop_(vehicle_, settings_),
        standby_server_(standby_loop_, settings_.limits, GainDesigner(vehicle_, settings_), wake_) {
    standby_server_.set_active(false);
  }
  static constexpr std::uint32_t kTerm = 7;

  // Passes the report of the active controller to the standby.
  void pass_state_to_standby(std::uint32_t term = kTerm) {
    comms::ControllerReport report;
    loop_.report(report);
    ASSERT_TRUE(report.active);
    comms::ControllerReport received;
    ASSERT_FALSE(comms::from_message(comms::to_message(report), received));
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
    const plant::ActuatorCommand command = standby_loop_.step(last_imu_, now_ns, role, kTerm);
    standby_loop_.finish(now_ns + 20'000);
    return command;
  }
  void fly_mission() {
    settle();
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
    comms::ControllerReport report;
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
  comms::ControllerReport active;
  loop_.report(active);
  const control::SupervisorState state = standby_state();
  EXPECT_EQ(state.mode, control::Mode::kMission);
  EXPECT_EQ(state.guidance.mission.id, 2U);
  EXPECT_EQ(state.guidance.phase, active.flight.supervisor.guidance.phase);
  EXPECT_EQ(state.guidance.path.segment.z, active.flight.supervisor.guidance.path.segment.z);
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
    const std::vector<RequestResult> answers = standby_server_.collect();
    ASSERT_EQ(answers.size(), 1U);
    EXPECT_TRUE(answers[0].outcome.accepted) << answers[0].outcome.reason;
    state = standby_state();
    EXPECT_EQ(state.mode, control::Mode::kMission);
    EXPECT_EQ(state.guidance.mission.state, control::MissionState::kRunning);
    standby_server_.set_active(false);
    command_server_.on_command(command(Command_Constants::DISARM, id + 2));
    step();
    command_server_.collect();
  }
}

TEST_F(CommandServerTest, RefusesADifferentMissionOfAKnownId) {
  settle();
  command_server_.on_mission(mission(2, 1.0));
  step();
  ASSERT_TRUE(command_server_.collect().at(0).outcome.accepted);
  msg::Mission other = mission(2, 1.5);
  other.client(kClient + 1);
  command_server_.on_mission(other);
  msg::Mission same = mission(2, 1.0);
  same.client(kClient + 2);
  command_server_.on_mission(same);
  step();
  const std::vector<RequestResult> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].client, kClient + 1);
  EXPECT_STREQ(answers[0].outcome.reason, "mission id 2 belongs to another mission: upload with a new id");
  EXPECT_TRUE(answers[1].outcome.accepted) << answers[1].outcome.reason;
}

TEST_F(StandbyCommandServerTest, StaysDisarmedWithoutTheMission) {
  fly_mission();
  follow(20);
  const control::SupervisorState state = standby_state();
  EXPECT_EQ(state.mode, control::Mode::kDisarmed);
  EXPECT_EQ(state.reason, control::Reason::kPlanUnknown);
}

TEST_F(StandbyCommandServerTest, IgnoresStateOfAnotherTerm) {
  settle();
  command_server_.on_command(command(Command_Constants::ARM, 1));
  step();
  comms::ControllerReport report;
  loop_.report(report);
  const auto mode_after_a_state_of = [&](std::uint32_t term) {
    FailoverState failover_state;
    failover_state.term = term;
    failover_state.flight = report.flight;
    standby_server_.follow(failover_state);
    step_standby(Role::kStandby);
    return standby_state().mode;
  };
  EXPECT_EQ(mode_after_a_state_of(kTerm - 1), control::Mode::kDisarmed);
  EXPECT_EQ(mode_after_a_state_of(kTerm + 1), control::Mode::kDisarmed);
  EXPECT_EQ(mode_after_a_state_of(kTerm), control::Mode::kArmed);
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

  const std::vector<RequestResult> answers = standby_server_.collect();
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].id, 1U);
  EXPECT_TRUE(answers[0].outcome.accepted);
  EXPECT_TRUE(answers[0].repeated);
  EXPECT_EQ(answers[1].id, 2U);
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

}  // namespace
}  // namespace swiftlet::services
