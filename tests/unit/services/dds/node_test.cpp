// Participants and nodes with their own sockets: delivery within one process uses the same path as
// between two.
#include "swiftlet/services/dds/node.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/unit/services/dds/node_settings.hpp"
#include "tests/unit/services/messages/messages.hpp"

namespace swiftlet::dds::fixtures::node_test {

using swiftlet::dds::DomainLock;
using swiftlet::tests::eventually;
using swiftlet::tests::Inbox;
using namespace std::chrono_literals;

TEST(Participant, IgnoresProcessesOfOtherVehiclesThatIgnoreIt) {
  const DomainLock lock;
  NodeSettings fleet = settings(lock, "plant");
  fleet.hears_of_all = false;
  const Participant plant(fleet, {"kl1"});
  const Participant other_plant(fleet, {"kl2"});
  const Participant tool(settings(lock, "tool"), {"kl1"});
  ASSERT_TRUE(eventually([&] { return tool.processes_seen().size() == 2; }))
      << "both have announced themselves";
  fleet.name = "mocap";
  const Participant motion_capture(fleet, {"kl1", "kl2"});
  for (const Participant* const it : {&plant, &other_plant})
    ASSERT_TRUE(eventually([&] { return it->processes_seen().size() == 2; })) << "tool and motion capture";
  for (const Participant* const it : {&plant, &other_plant}) {
    for (const ProcessIdentity& seen : it->processes_seen()) EXPECT_NE(seen.name, "plant");
  }
}

// Fast DDS would map files of /dev/shm, and end with a bus error where it is full.
TEST(Participant, UsesNoSharedMemory) {
  const DomainLock lock;
  Node plant(settings(lock, "plant"));
  Node ground(settings(lock, "ground"));
  const Publisher<messages::msg::Battery> battery = plant.publish(messages::topics::kBattery);
  const Subscription subscription =
      ground.subscribe<messages::msg::Battery>(messages::topics::kBattery, [](const auto&) {});
  ASSERT_TRUE(eventually([&] { return subscription.matched() == 1; }));
  EXPECT_EQ(io::read_text_file("/proc/self/maps").find("/dev/shm"), std::string::npos);
}

TEST(Node, ACallbackThatThrowsEndsItsSubscriptionAlone) {
  const DomainLock lock;
  Participant there(settings(lock, "there"), {"kl1", "kl2"});
  Node here(settings(lock, "here"));
  Inbox<std::string> faults;
  std::atomic<int> ill_calls{0};
  Node ill(there, "kl1", [&](const std::string& fault) { faults.put(fault); });
  Node well(there, "kl1");
  Inbox<messages::msg::Imu> inbox;
  const auto throws =
      ill.subscribe<messages::msg::Imu>(messages::topics::kImu, [&](const messages::msg::Imu&) {
        ++ill_calls;
        throw std::runtime_error("the step failed");
      });
  const auto receives = well.subscribe<messages::msg::Imu>(
      messages::topics::kImu, [&](const messages::msg::Imu& imu) { inbox.put(imu); });
  auto publisher = here.publish(messages::topics::kImu);
  ASSERT_TRUE(eventually([&] { return publisher.matched() == 2; }));
  ASSERT_TRUE(eventually([&] {
    publisher.publish(messages::fixtures::example<messages::msg::Imu>());
    return faults.size() > 0 && inbox.size() > 5;
  }));
  EXPECT_EQ(faults.items(), std::vector<std::string>({"the step failed"}));
  EXPECT_EQ(ill_calls, 1);
}

TEST(NodeDeathTest, ACallbackThatThrowsEndsTheProcess) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto receive_and_throw = [] {
    const DomainLock lock;
    Node here(settings(lock, "here"));
    Node there(settings(lock, "there"));
    const auto throws = there.subscribe<messages::msg::Imu>(
        messages::topics::kImu,
        [](const messages::msg::Imu&) { throw std::runtime_error("the step failed"); });
    auto publisher = here.publish(messages::topics::kImu);
    eventually(
        [&] {
          publisher.publish(messages::fixtures::example<messages::msg::Imu>());
          return false;
        },
        20s);
  };
  EXPECT_DEATH(receive_and_throw(), "the step failed");
  const auto discover_and_throw = [] {
    const DomainLock lock;
    Node here(settings(lock, "here"));
    here.on_peer([](const PeerEvent&) { throw std::runtime_error("the log is full"); });
    Node there(settings(lock, "there"));
    eventually([] { return false; }, 20s);
  };
  EXPECT_DEATH(discover_and_throw(), "the log is full");
}

TEST(Node, NoNameOfAPeerControlsATerminal) {
  const DomainLock lock;
  Inbox<std::string> names;
  Node here(settings(lock, "here"));
  here.on_peer([&](const PeerEvent& event) { names.put(event.name); });
  Node there(settings(lock, "\x1b[2Jground\n12:00:00 control info: landed"));
  ASSERT_TRUE(eventually([&] { return names.size() > 0; }));
  EXPECT_EQ(names.items().front(), "?[2Jground?12:00:00 control info: landed");
}

int threads_of_this_process() {
  const std::filesystem::directory_iterator tasks("/proc/self/task");
  return static_cast<int>(std::distance(begin(tasks), end(tasks)));
}

// GIVEN a participant that serves vehicles WHEN samples of several kinds and vehicles come THEN those of one kind come in one
// thread, those of another kind in another, and a further vehicle takes none.
TEST(Delivery, OneThreadServesAKindOfSamplesOfAllVehicles) {
  const DomainLock lock;
  const Participant sensors(settings(lock, "plant"), {"kl1", "kl2"});
  const Participant control(settings(lock, "control"), {"kl1", "kl2"});
  std::mutex mutex;
  std::map<Delivery, std::set<std::thread::id>> threads;
  std::map<Delivery, int> received;
  const auto note = [&](Delivery delivery) {
    const std::lock_guard<std::mutex> guard(mutex);
    threads[delivery].insert(std::this_thread::get_id());
    ++received[delivery];
  };
  std::vector<std::unique_ptr<Node>> nodes;
  std::vector<Subscription> subscriptions;
  std::vector<Publisher<messages::msg::Imu>> imu;
  std::vector<Publisher<messages::msg::MocapPose>> poses;
  std::vector<Publisher<messages::msg::Battery>> batteries;
  int threads_before = 0;
  for (const std::string vehicle : {"kl1", "kl2"}) {
    threads_before = threads_of_this_process();
    Node& reading = *nodes.emplace_back(std::make_unique<Node>(control, vehicle));
    Node& writing = *nodes.emplace_back(std::make_unique<Node>(sensors, vehicle));
    subscriptions.push_back(reading.subscribe<messages::msg::Imu>(
        messages::topics::kImu, [&](const auto&) { note(Delivery::kSamples); }, Delivery::kSamples));
    subscriptions.push_back(reading.subscribe<messages::msg::MocapPose>(
        messages::topics::kMocapPose, [&](const auto&) { note(Delivery::kSensors); }, Delivery::kSensors));
    subscriptions.push_back(reading.subscribe<messages::msg::Battery>(
        messages::topics::kBattery, [&](const auto&) { note(Delivery::kShared); }));
    imu.push_back(writing.publish(messages::topics::kImu));
    poses.push_back(writing.publish(messages::topics::kMocapPose));
    batteries.push_back(writing.publish(messages::topics::kBattery));
  }
  EXPECT_EQ(threads_of_this_process(), threads_before) << "of the second vehicle";
  ASSERT_TRUE(eventually([&] {
    return std::all_of(subscriptions.begin(), subscriptions.end(),
                       [](const auto& one) { return one.matched() == 1; });
  }));
  EXPECT_TRUE(eventually([&] {
    for (auto& publisher : imu) publisher.publish(messages::fixtures::example<messages::msg::Imu>());
    for (auto& publisher : poses) publisher.publish(messages::fixtures::example<messages::msg::MocapPose>());
    for (auto& publisher : batteries)
      publisher.publish(messages::fixtures::example<messages::msg::Battery>());
    const std::lock_guard<std::mutex> guard(mutex);
    return received[Delivery::kSamples] >= 4 && received[Delivery::kSensors] >= 4 &&
           received[Delivery::kShared] >= 4;
  }));
  const std::lock_guard<std::mutex> guard(mutex);
  std::set<std::thread::id> all;
  for (const auto& [delivery, of_delivery] : threads) {
    EXPECT_EQ(of_delivery.size(), 1U);
    all.insert(of_delivery.begin(), of_delivery.end());
  }
  EXPECT_EQ(all.size(), 3U);
}

TEST(Vehicles, AreIsolatedFromEachOther) {
  const DomainLock lock;
  NodeSettings first = settings(lock, "plant");
  NodeSettings second = first;
  second.vehicle = "kl2";
  Node plant1(first);
  Node plant2(second);
  first.name = second.name = "control";
  Inbox<std::string> peers;
  Node control1(first);
  control1.on_peer([&](const PeerEvent& event) { peers.put(event.name); });
  Inbox<std::uint64_t> received;
  const auto subscription = control1.subscribe<messages::msg::Imu>(
      messages::topics::kImu, [&](const messages::msg::Imu& imu) { received.put(imu.sequence_number()); });
  Node control2(second);
  const auto other =
      control2.subscribe<messages::msg::Imu>(messages::topics::kImu, [](const messages::msg::Imu&) {});
  auto imu1 = plant1.publish(messages::topics::kImu);
  auto imu2 = plant2.publish(messages::topics::kImu);
  ASSERT_TRUE(
      eventually([&] { return imu1.matched() == 1 && imu2.matched() == 1 && subscription.matched() == 1; }));

  messages::msg::Imu imu;
  imu.sequence_number(2);
  imu2.publish(imu);
  imu.sequence_number(1);
  imu1.publish(imu);

  ASSERT_TRUE(received.wait_for_count(1));
  EXPECT_EQ(received.items().front(), 1U);
  ASSERT_TRUE(peers.wait_for_count(1));
  EXPECT_EQ(peers.items(), std::vector<std::string>{"plant"});
}

// GIVEN the processes of two vehicles WHEN one participant serves both THEN each node communicates with its
// own vehicle only, and each side reports the other as its peer.
TEST(Vehicles, CanShareAParticipant) {
  const DomainLock lock;
  NodeSettings plant = settings(lock, "plant");
  Node plant1(plant);
  plant.vehicle = "kl2";
  Inbox<std::string> peers_of_plant2;
  Node plant2(plant);
  plant2.on_peer([&](const PeerEvent& event) { peers_of_plant2.put(event.name); });

  const Participant shared(settings(lock, "ground"));
  Node ground1(shared, "kl1");
  auto imu1 = plant1.publish(messages::topics::kImu);
  auto imu2 = plant2.publish(messages::topics::kImu);
  Inbox<std::uint64_t> received1;
  const auto first = ground1.subscribe<messages::msg::Imu>(
      messages::topics::kImu, [&](const messages::msg::Imu& imu) { received1.put(imu.sequence_number()); });
  ASSERT_TRUE(eventually([&] { return first.matched() == 1; }));

  Inbox<std::string> peers_of_ground2;
  Node ground2(shared, "kl2");
  ground2.on_peer([&](const PeerEvent& event) { peers_of_ground2.put(event.name); });
  Inbox<std::uint64_t> received2;
  const auto second = ground2.subscribe<messages::msg::Imu>(
      messages::topics::kImu, [&](const messages::msg::Imu& imu) { received2.put(imu.sequence_number()); });
  auto command1 = ground1.publish(messages::topics::kCommand);
  auto command2 = ground2.publish(messages::topics::kCommand);
  ASSERT_TRUE(
      eventually([&] { return second.matched() == 1 && imu1.matched() == 1 && imu2.matched() == 1; }));
  EXPECT_EQ(first.matched(), 1);
  EXPECT_EQ(command1.matched() + command2.matched(), 0);

  messages::msg::Imu imu;
  imu.sequence_number(1);
  imu1.publish(imu);
  imu.sequence_number(2);
  imu2.publish(imu);
  ASSERT_TRUE(received1.wait_for_count(1));
  ASSERT_TRUE(received2.wait_for_count(1));
  EXPECT_EQ(received1.items(), std::vector<std::uint64_t>{1});
  EXPECT_EQ(received2.items(), std::vector<std::uint64_t>{2});
  ASSERT_TRUE(peers_of_ground2.wait_for_count(1));
  EXPECT_EQ(peers_of_ground2.items(), std::vector<std::string>{"plant"});
  ASSERT_TRUE(peers_of_plant2.wait_for_count(1));
  EXPECT_EQ(peers_of_plant2.items(), std::vector<std::string>{"ground"});
}

TEST(Subscription, DeliversNothingAfterItsDestruction) {
  const DomainLock lock;
  Node plant(settings(lock, "plant"));
  Node control(settings(lock, "control"));
  auto publisher = plant.publish(messages::topics::kImu);
  for (int round = 0; round < 20; ++round) {
    std::atomic<bool> gone{false};
    std::atomic<int> received{0};
    std::atomic<int> received_when_gone{0};
    auto subscription =
        control.subscribe<messages::msg::Imu>(messages::topics::kImu, [&](const messages::msg::Imu&) {
          if (gone) ++received_when_gone;
          ++received;
        });
    ASSERT_TRUE(eventually([&] {
      publisher.publish(messages::fixtures::example<messages::msg::Imu>());
      return received > 0;
    }));
    subscription = {};
    gone = true;
    publisher.publish(messages::fixtures::example<messages::msg::Imu>());
    EXPECT_EQ(received_when_gone, 0);
  }
}

TEST(NodeSettings, RefusesInvalidValues) {
  NodeSettings settings;
  settings.name = "plant";
  settings.domain = 233;
  try {
    const Node node(settings);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "DDS domain is 233, must be between 0 and 232");
  }
  settings.domain = 1;
  settings.vehicle = "kl/1";
  try {
    const Node node(settings);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(
        error.what(),
        "vehicle name is 'kl/1', must be 1 to 64 letters, digits and _, begin with a letter and have no __");
  }
}

}  // namespace swiftlet::dds::fixtures::node_test
