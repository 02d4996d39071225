// Which orders of the fleet's monitor are sent. The test stands in for the control service.
#include "swiftlet/ground/fleet/order_sender.hpp"

#include <atomic>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/private_domain.hpp"

namespace swiftlet::ground::order_sender_test {

using tests::eventually;
using tests::settings_of;

class NoProgress final : public io::Progress {
 public:
  void update(int, const std::string&) override {}
  void say(const std::string&) override {}
};

// GIVEN an order that waits in the sender WHEN the flight is abandoned THEN it is not sent, and cannot end the landing.
TEST(OrderSender, SendsNothingOnceTheFlightIsAbandoned) {
  const dds::DomainLock lock;
  dds::Node control(settings_of("control", lock));
  tests::Inbox<messages::msg::Command> commands;
  auto acks = control.publish(messages::topics::kCommandAck);
  auto missions = control.publish(messages::topics::kMissionStatus);
  const dds::Subscription subscription = control.subscribe<messages::msg::Command>(
      messages::topics::kCommand, [&](const messages::msg::Command& command) {
        commands.put(command);
        messages::msg::CommandAck ack;
        ack.client(command.client());
        ack.id(command.id());
        ack.accepted(true);
        acks.publish(ack);
      });
  const auto client = std::make_shared<Client>(settings_of("ground", lock));
  ASSERT_TRUE(eventually([&] {
    messages::msg::MissionStatus running;
    running.state(messages::msg::MissionStatus_Constants::RUNNING);
    missions.publish(running);
    return client->view().mission.seen();
  }));

  std::atomic<bool> is_abandoned{true};
  std::atomic<int> asked{0};
  NoProgress progress;
  OrderSender sender(client, progress, [&] {
    const bool gives_up = is_abandoned;
    ++asked;
    return gives_up;
  });
  const Order pause{Order::Kind::kPause, Eigen::Vector3d::Zero(), 1};
  sender.give(pause, "kl2");
  ASSERT_TRUE(eventually([&] { return asked > 0; }));
  is_abandoned = false;
  sender.give(pause, "kl2");
  ASSERT_TRUE(commands.wait_for_count(1));
  EXPECT_EQ(commands.items().front().kind(), messages::msg::Command_Constants::MISSION_PAUSE);
  // Requests are numbered in order: this is the first one that was made.
  const Result next = client->request(control::Request(), tests::kStuck);
  EXPECT_EQ(next.key.id, commands.items().front().id() + 1);
}

}  // namespace swiftlet::ground::order_sender_test
