// Requests through the command server and the inner loop, and the allocations of the inner loop.
#include "swiftlet/services/control/command_server.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/eventually.hpp"
#include "tests/support/malloc_guard.hpp"
#include "tests/unit/services/control/command_server_fixture.hpp"

namespace swiftlet::services::command_server_test {

using namespace std::chrono_literals;

TEST_F(CommandServerTest, AnswersARequestInTheNextStep) {
  settle();
  command_server_.on_command(command(Command_Constants::ARM, 1));
  EXPECT_TRUE(command_server_.collect().empty());

  EXPECT_EQ(step().rotor_state, plant::RotorState::kRunning);

  const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].client(), kClient);
  EXPECT_EQ(answers[0].id(), 1U);
  EXPECT_TRUE(answers[0].accepted()) << answers[0].reason();
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
  for (const messages::msg::CommandAck& answer : command_server_.collect())
    EXPECT_GT(answer.stamp_ns(), 0) << answer.id();
  command_server_.on_command(command(Command_Constants::TAKEOFF, 2));
  const std::vector<messages::msg::CommandAck> again = command_server_.collect();
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0].stamp_ns(), accepted_ns);
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
  std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_TRUE(answers[0].accepted()) << answers[0].reason();
  mode();
  EXPECT_DOUBLE_EQ(last_.gains.position_p.x(), 1.8);
  EXPECT_STREQ(last_.status.settings.data(), "soft");

  // The next change begins at these gains.
  command_server_.on_control_settings(settings_message(2, 2.0));
  step();
  EXPECT_EQ(command_server_.collect().at(0).reason(),
            "another request changed the gains meanwhile; send this one again");
  command_server_.set_gains_in_force(last_.gains);
  command_server_.on_control_settings(settings_message(3, 2.0));
  step();
  answers = command_server_.collect();
  EXPECT_TRUE(answers.at(0).accepted()) << answers[0].reason();
}

TEST_F(CommandServerTest, RefusesUnstableGainsBeforeTheInnerLoop) {
  command_server_.on_control_settings(settings_message(1, 6.0, 0.2));
  const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U) << "without a step";
  EXPECT_EQ(answers[0].reason(), "position.x: with the rotor lag the loop is unstable");
}

TEST_F(CommandServerTest, AnswersARefusalWithItsReason) {
  settle();
  command_server_.on_command(command(Command_Constants::LAND, 1));
  step();
  const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_FALSE(answers[0].accepted());
  EXPECT_GT(answers[0].reason().to_string().size(), 0U);
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
  const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].id(), 1U);
  EXPECT_TRUE(answers[0].accepted());
  EXPECT_EQ(mode(), control::Mode::kDisarmed);
}

TEST_F(CommandServerTest, IgnoresRepetitionsOfAPendingRequest) {
  settle();
  for (int i = 0; i < 3; ++i) command_server_.on_command(command(Command_Constants::ARM, 1));
  step();
  EXPECT_EQ(command_server_.collect().size(), 1U);
}

// GIVEN a mission that takes long to check WHEN a command with its client and id arrives meanwhile THEN the one heard
// first is evaluated and answered, and the other one is taken for its repetition.
TEST_F(CommandServerTest, ARequestClaimsItsKeyBeforeItIsChecked) {
  settle();
  control::Mission lengthy;  // its rotor thrusts are checked at 40,000 points
  lengthy.segments.assign(100, control::minimum_jerk({0, 0, -1}, 0.0, {0, 0, -1}, 0.0, 2.0));
  lengthy.items = {
      {control::MissionItemKind::kTakeoff, {0, 0, -1}, 0.0, true, 0.5, 0.0},
      {control::MissionItemKind::kTrajectory, {0, 0, 0}, 0.0, true, 0.5, 0.0, 0, 100},
  };
  for (std::uint64_t id = 1; id <= 5; ++id) {  // the threads may be delayed now and then
    lengthy.id = id;
    msg::Mission mission = messages::to_message(lengthy);
    mission.client(kClient);
    std::atomic<bool> begins{false};
    std::thread upload([&] {
      begins = true;
      command_server_.on_mission(mission);
    });
    while (!begins) std::this_thread::yield();
    command_server_.on_command(command(Command_Constants::HOLD, id));
    upload.join();
    EXPECT_EQ(loop_.requests.read_available(), 1U);
    step();
    const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
    EXPECT_EQ(answers.size(), 1U);
    for (const messages::msg::CommandAck& answer : answers) EXPECT_EQ(answer.id(), id);
  }
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

  const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 4U);
  for (const messages::msg::CommandAck& answer : answers) EXPECT_FALSE(answer.accepted());
  EXPECT_EQ(answers[0].reason(), "position_ned[1] is nan, must be finite");
  EXPECT_NE(answers[1].reason().to_string().find("item 2: x is 99.000 m"), std::string::npos);
  EXPECT_EQ(answers[2].reason(), "item 2: speed is nan, must be finite");
  EXPECT_EQ(answers[3].reason(), "the trajectory has no segments");
  EXPECT_EQ(loop_.requests.read_available(), 0U);
}

// A yaw acceleration of up to 577 rad/s^2, within all limits of speed and acceleration.
TEST_F(CommandServerTest, RefusesPathsBeyondItsRotors) {
  control::Trajectory spin;
  spin.id = 1;
  spin.segments = {control::minimum_jerk({0, 0, -1}, 0.0, {0, 0, -1}, 1.0, 0.1)};
  msg::Trajectory message = messages::to_message(spin);
  message.client(kClient);
  command_server_.on_trajectory(message);
  control::Mission around;
  around.id = 2;
  around.segments = spin.segments;
  around.items = {
      {control::MissionItemKind::kTakeoff, {0, 0, -1}, 0.0, true, 0.5, 0.0},
      {control::MissionItemKind::kTrajectory, {0, 0, 0}, 0.0, false, 0.5, 0.0, 0, 1},
  };
  msg::Mission mission = messages::to_message(around);
  mission.client(kClient);
  command_server_.on_mission(mission);
  const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 2U);
  for (const messages::msg::CommandAck& answer : answers) EXPECT_FALSE(answer.accepted());
  EXPECT_EQ(answers[0].reason().to_string().rfind("the trajectory: least thrust of a rotor is ", 0), 0U)
      << answers[0].reason();
  EXPECT_EQ(answers[1].reason().to_string().rfind("the mission: least thrust of a rotor is ", 0), 0U)
      << answers[1].reason();
  EXPECT_NE(answers[1].reason().to_string().find(" s, segment 1, (0.00, 0.00, -1.00) m NED"),
            std::string::npos);
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
  const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 3U);
  ASSERT_TRUE(answers[1].accepted()) << answers[1].reason();
  ASSERT_TRUE(answers[2].accepted()) << answers[2].reason();
  for (int i = 0; i < 100; ++i) step();
  EXPECT_EQ(mode(), control::Mode::kMission);
  EXPECT_EQ(last_.status.mission.id, 2U);
  EXPECT_EQ(last_.status.mission.item_count, 3);
}

TEST_F(CommandServerTest, RefusesRequestsWithoutImuSamples) {
  settle();
  command_server_.on_command(command(Command_Constants::ARM, 1));
  std::vector<messages::msg::CommandAck> answers;
  ASSERT_TRUE(tests::eventually([&] {
    answers = command_server_.collect();
    return !answers.empty();
  }));
  EXPECT_FALSE(answers[0].accepted());
  EXPECT_EQ(answers[0].reason(), "no IMU samples arrive: is the vehicle running?");

  EXPECT_EQ(step().rotor_state, plant::RotorState::kOff);
  EXPECT_TRUE(command_server_.collect().empty());
  EXPECT_EQ(mode(), control::Mode::kDisarmed);
}

TEST_F(CommandServerTest, RefusesRequestsBeyondItsCapacity) {
  for (std::uint64_t id = 1; id <= kMaxPendingRequests; ++id)
    command_server_.on_command(command(Command_Constants::HOLD, id));
  const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].id(), static_cast<std::uint64_t>(kMaxPendingRequests));
  EXPECT_EQ(answers[0].reason(), "31 requests are pending, the limit");
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
  const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_TRUE(answers[0].accepted());
  EXPECT_EQ(answers[0].stamp_ns(), 7);
  EXPECT_STREQ(
      answers[0].reason(),
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
  const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 3U);
  for (const messages::msg::CommandAck& answer : answers) EXPECT_TRUE(answer.accepted()) << answer.id();
}

TEST_F(CommandServerTest, LetsTheInnerLoopAnswerAStopWhileSamplesArrive) {
  settle();
  command_server_.on_command(command(Command_Constants::STOP, 1));
  EXPECT_FALSE(command_server_.accept_overdue_stop(0.002, 7));
  step();
  const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_TRUE(answers[0].accepted());
  EXPECT_EQ(answers[0].reason(), "");
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

// A standby that hears both would keep the first one, and fly it after a failover.
TEST_F(CommandServerTest, RefusesADifferentMissionOfAPendingId) {
  settle();
  command_server_.on_mission(mission(2, 1.0));
  msg::Mission other = mission(2, 1.5);
  other.client(kClient + 1);
  command_server_.on_mission(other);
  step();
  const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].client(), kClient + 1);
  EXPECT_EQ(answers[0].reason(), "mission id 2 belongs to another mission: upload with a new id");
  EXPECT_TRUE(answers[1].accepted()) << answers[1].reason();
  EXPECT_EQ(command_server_.mission(2).items().at(1).position_ned()[0], 1.0);
}

TEST_F(CommandServerTest, RefusesADifferentMissionOfAKnownId) {
  settle();
  command_server_.on_mission(mission(2, 1.0));
  step();
  ASSERT_TRUE(command_server_.collect().at(0).accepted());
  msg::Mission other = mission(2, 1.5);
  other.client(kClient + 1);
  command_server_.on_mission(other);
  msg::Mission same = mission(2, 1.0);
  same.client(kClient + 2);
  command_server_.on_mission(same);
  step();
  const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].client(), kClient + 1);
  EXPECT_EQ(answers[0].reason(), "mission id 2 belongs to another mission: upload with a new id");
  EXPECT_TRUE(answers[1].accepted()) << answers[1].reason();
}

}  // namespace swiftlet::services::command_server_test
