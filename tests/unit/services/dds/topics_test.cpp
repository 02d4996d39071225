// Every topic between participants with their own sockets: what arrives, in which order, and who hears it.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet_msgs/msg/CommandPubSubTypes.h"

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/serialization.hpp"
#include "tests/unit/services/dds/node_settings.hpp"
#include "tests/unit/services/dds/steady_sender.hpp"
#include "tests/unit/services/messages/messages.hpp"

namespace swiftlet::dds::fixtures::topics_test {

using swiftlet::dds::DomainLock;
using swiftlet::tests::eventually;
using swiftlet::tests::Inbox;
using namespace std::chrono_literals;

TEST(EachTopic, ArrivesUnchanged) {
  const DomainLock lock;
  Node here(settings(lock, "here"));
  Node there(settings(lock, "there"));
  messages::for_each_topic([&](const auto& topic) {
    SCOPED_TRACE(topic.name);
    using Message = typename std::decay_t<decltype(topic)>::Message;
    Inbox<Message> inbox;
    const auto subscription =
        there.subscribe<Message>(topic, [&](const Message& message) { inbox.put(message); });
    auto publisher = here.publish(topic);
    ASSERT_TRUE(eventually([&] { return publisher.matched() == 1 && subscription.matched() == 1; }));

    const auto sent = messages::fixtures::example<Message>();
    ASSERT_TRUE(publisher.publish(sent));

    ASSERT_TRUE(inbox.wait_for_count(1));
    EXPECT_TRUE(inbox.items().front() == sent);
  });
}

TEST(LongMission, ArrivesWhole) {
  const DomainLock lock;
  Node ground(settings(lock, "ground"));
  Node control(settings(lock, "control"));
  Inbox<messages::msg::Mission> missions;
  Inbox<messages::msg::Trajectory> trajectories;
  const auto mission_subscription = control.subscribe<messages::msg::Mission>(
      messages::topics::kMission, [&](const messages::msg::Mission& m) { missions.put(m); });
  const auto trajectory_subscription = control.subscribe<messages::msg::Trajectory>(
      messages::topics::kTrajectory, [&](const messages::msg::Trajectory& t) { trajectories.put(t); });
  auto mission_publisher = ground.publish(messages::topics::kMission);
  auto trajectory_publisher = ground.publish(messages::topics::kTrajectory);
  ASSERT_TRUE(
      eventually([&] { return mission_publisher.matched() == 1 && mission_subscription.matched() == 1; }));
  ASSERT_TRUE(eventually(
      [&] { return trajectory_publisher.matched() == 1 && trajectory_subscription.matched() == 1; }));

  const messages::msg::Mission mission = messages::to_message(
      messages::fixtures::mission(control::kMaxMissionItems, control::kMaxTrajectorySegments));
  const messages::msg::Trajectory trajectory =
      messages::to_message(messages::fixtures::trajectory(control::kMaxTrajectorySegments));
  ASSERT_TRUE(mission_publisher.publish(mission));
  ASSERT_TRUE(trajectory_publisher.publish(trajectory));

  ASSERT_TRUE(missions.wait_for_count(1));
  ASSERT_TRUE(trajectories.wait_for_count(1));
  EXPECT_TRUE(missions.items().front() == mission);
  EXPECT_TRUE(trajectories.items().front() == trajectory);
}

// A recorder and another reader share a participant.
TEST(RawSubscription, DeliversThePayloadWithStampAndNumber) {
  struct Kept {
    std::vector<unsigned char> payload;
    std::int64_t source_stamp_ns;
    std::uint64_t sequence_number;
    std::uint64_t writer;
  };
  const DomainLock lock;
  Node here(settings(lock, "here"));
  Node there(settings(lock, "there"));
  Inbox<Kept> raw;
  Inbox<messages::msg::Command> converted;
  const auto keep = [&](const RawSample& sample) {
    raw.put({{sample.payload, sample.payload + sample.size},
             sample.source_stamp_ns,
             sample.sequence_number,
             sample.writer});
  };
  const Subscription recorded = there.subscribe_raw<messages::msg::Command>(messages::topics::kCommand, keep);
  const Subscription used = there.subscribe<messages::msg::Command>(
      messages::topics::kCommand, [&](const messages::msg::Command& command) { converted.put(command); });
  Publisher<messages::msg::Command> publisher = here.publish(messages::topics::kCommand);
  ASSERT_TRUE(eventually([&] { return publisher.matched() == 2; }));
  const auto now_ns = [] {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
  };
  const std::int64_t before_ns = now_ns();
  std::vector<messages::msg::Command> sent(3, messages::fixtures::example<messages::msg::Command>());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    sent[i].id(i + 1);
    ASSERT_TRUE(publisher.publish(sent[i]));
  }
  ASSERT_TRUE(raw.wait_for_count(3) && converted.wait_for_count(3));
  const std::int64_t after_ns = now_ns();
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const Kept kept = raw.items()[i];
    EXPECT_EQ(kept.payload, swiftlet::tests::serialized<messages::msg::CommandPubSubType>(sent[i]));
    EXPECT_EQ(kept.sequence_number, raw.items()[0].sequence_number + i);
    EXPECT_EQ(kept.writer, raw.items()[0].writer);
    EXPECT_GE(kept.source_stamp_ns, before_ns - 1000);  // the middleware keeps fractions of 2^-32 s
    EXPECT_LE(kept.source_stamp_ns, after_ns);
    EXPECT_EQ(converted.items()[i].id(), i + 1);
  }
}

TEST(Requests, ArriveInOrder) {
  const DomainLock lock;
  Node ground(settings(lock, "ground"));
  Node control(settings(lock, "control"));
  Inbox<std::uint64_t> ids;
  const auto subscription = control.subscribe<messages::msg::Command>(
      messages::topics::kCommand, [&](const messages::msg::Command& c) { ids.put(c.id()); });
  auto publisher = ground.publish(messages::topics::kCommand);
  ASSERT_TRUE(eventually([&] { return publisher.matched() == 1 && subscription.matched() == 1; }));

  constexpr std::uint64_t kCount = std::uint64_t{3} * messages::kKeptRequests;
  messages::msg::Command command;
  for (std::uint64_t id = 1; id <= kCount; ++id) {
    command.id(id);
    ASSERT_TRUE(publisher.publish(command)) << id;
  }

  ASSERT_TRUE(ids.wait_for_count(kCount));
  std::uint64_t expected = 0;
  for (const std::uint64_t id : ids.items()) EXPECT_EQ(id, ++expected);
}

TEST(LastSample, IsReceivedBeforeItsWriterEnds) {
  const DomainLock lock;
  Node ground(settings(lock, "ground"));
  Node control(settings(lock, "control"));
  std::promise<void> release;
  Inbox<bool> busy;
  Inbox<messages::msg::MissionStatus> inbox;
  const auto blocked = control.subscribe<messages::msg::Battery>(messages::topics::kBattery,
                                                                 [&](const messages::msg::Battery&) {
                                                                   busy.put(true);
                                                                   release.get_future().wait();
                                                                 });
  const auto subscription = control.subscribe<messages::msg::MissionStatus>(
      messages::topics::kMissionStatus,
      [&](const messages::msg::MissionStatus& message) { inbox.put(message); });
  auto battery = ground.publish(messages::topics::kBattery);
  auto state = std::make_unique<Publisher<messages::msg::MissionStatus>>(
      ground.publish(messages::topics::kMissionStatus));
  ASSERT_TRUE(eventually([&] { return battery.matched() == 1 && state->matched() == 1; }));
  ASSERT_TRUE(eventually([&] { return blocked.matched() == 1 && subscription.matched() == 1; }));

  battery.publish(messages::fixtures::example<messages::msg::Battery>());
  ASSERT_TRUE(busy.wait_for_count(1));
  state->publish(messages::fixtures::example<messages::msg::MissionStatus>());
  EXPECT_FALSE(state->wait_until_received(50ms)) << "the only receive thread is busy";
  release.set_value();
  EXPECT_TRUE(state->wait_until_received(5s));
  state.reset();
  EXPECT_TRUE(inbox.wait_for_count(1));
}

TEST(LatchedTopic, ReachesLateJoiners) {
  const DomainLock lock;
  Node control(settings(lock, "control"));
  auto publisher = control.publish(messages::topics::kControlStatus);
  messages::msg::ControlStatus status = messages::fixtures::example<messages::msg::ControlStatus>();
  status.sequence_number(1);
  ASSERT_TRUE(publisher.publish(status));
  status.sequence_number(2);
  ASSERT_TRUE(publisher.publish(status));

  Node ground(settings(lock, "ground"));
  Inbox<messages::msg::ControlStatus> inbox;
  const auto subscription = ground.subscribe<messages::msg::ControlStatus>(
      messages::topics::kControlStatus,
      [&](const messages::msg::ControlStatus& message) { inbox.put(message); });

  ASSERT_TRUE(inbox.wait_for_count(1));
  EXPECT_TRUE(inbox.items().front() == status);
}

TEST(Replies, ReachAReaderThatIsDiscoveredAfterThem) {
  const DomainLock lock;
  Node control(settings(lock, "control"));
  auto publisher = control.publish(messages::topics::kCommandAck);
  messages::msg::CommandAck ack;
  for (std::uint64_t id = 1; id <= std::uint64_t{messages::kKeptReplies} + 3; ++id) {
    ack.id(id);
    ASSERT_TRUE(publisher.publish(ack)) << id;
  }
  Node ground(settings(lock, "ground"));
  Inbox<std::uint64_t> ids;
  const auto subscription = ground.subscribe<messages::msg::CommandAck>(
      messages::topics::kCommandAck,
      [&](const messages::msg::CommandAck& message) { ids.put(message.id()); });
  ASSERT_TRUE(ids.wait_for_count(messages::kKeptReplies));
  std::uint64_t expected = 3;
  for (const std::uint64_t id : ids.items()) EXPECT_EQ(id, ++expected);
}

// A vehicle hears every controller: it decides by their terms.
TEST(Commands, OfAllControllersAreDelivered) {
  const DomainLock lock;
  Node plant(settings(lock, "plant"));
  Inbox<std::uint64_t> received;
  const auto subscription = plant.subscribe<messages::msg::ActuatorCommand>(
      messages::topics::kActuatorCommand,
      [&](const messages::msg::ActuatorCommand& command) { received.put(command.sequence_number()); });
  Node first(settings(lock, "control"));
  Node second(settings(lock, "control"));
  auto of_first = first.publish(messages::topics::kActuatorCommand);
  auto of_second = second.publish(messages::topics::kActuatorCommand);
  const SteadySender first_sender(of_first, 1);
  const SteadySender second_sender(of_second, 2);
  EXPECT_TRUE(received.wait([](const std::vector<std::uint64_t>& numbers) {
    return std::count(numbers.begin(), numbers.end(), 1U) >= 20 &&
           std::count(numbers.begin(), numbers.end(), 2U) >= 20;
  }));
}

// GIVEN a controller that reads the topic that it publishes itself WHEN others read it, leave, come back, and it rejoins THEN they hear
// it each time, and it never hears itself.
TEST(Streams, AreHeardByOthersNotByThePublisher) {
  const DomainLock lock;
  Node control(settings(lock, "control"));
  std::atomic<int> own{0};
  auto states = control.publish(messages::topics::kControllerState);
  const auto reads = control.subscribe<messages::msg::ControllerState>(messages::topics::kControllerState,
                                                                       [&](const auto&) { ++own; });
  const auto is_heard = [&] {
    Node standby(settings(lock, "control"));
    std::atomic<int> heard{0};
    const auto subscription = standby.subscribe<messages::msg::ControllerState>(
        messages::topics::kControllerState, [&](const auto&) { ++heard; });
    return eventually([&] {
      states.publish(messages::fixtures::example<messages::msg::ControllerState>());
      return heard >= 3;
    });
  };
  EXPECT_TRUE(is_heard());
  EXPECT_TRUE(is_heard()) << "by another one, after the first has left";
  control.rejoin();
  EXPECT_TRUE(is_heard()) << "after a rejoin";
  EXPECT_EQ(own, 0);
}

}  // namespace swiftlet::dds::fixtures::topics_test
