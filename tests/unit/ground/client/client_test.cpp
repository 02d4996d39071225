// How often a request is sent, and that the active controller answers it. The test stands in for the control
// service.
#include "swiftlet/ground/client/client.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/messages/wire_version.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/private_domain.hpp"

namespace swiftlet::ground::client_test {

using dds::DomainLock;
using tests::eventually;
using tests::Inbox;
using tests::settings_of;
using namespace std::chrono_literals;

// Receives requests and optionally answers them.
class Control {
 public:
  explicit Control(const DomainLock& lock, bool answers = false)
      : answers_(answers),
        node_(settings_of("control", lock)),
        acks_(node_.publish(messages::topics::kCommandAck)),
        statuses_(node_.publish(messages::topics::kControlStatus)) {
    commands_ =
        node_.subscribe<msg::Command>(messages::topics::kCommand, [this](const msg::Command& command) {
          commands_received_.put(command);
          received_.put(command.id());
          if (answers_) answer(command.client(), command.id());
        });
    missions_ = node_.subscribe<msg::Mission>(
        messages::topics::kMission, [this](const msg::Mission& mission) { received_.put(mission.id()); });
  }
  void publish_status(std::uint64_t sequence_number, std::uint32_t wire_version = messages::kWireVersion) {
    msg::ControlStatus status;
    status.wire_version(wire_version);
    status.sequence_number(sequence_number);
    statuses_.publish(status);
  }
  void answers(bool answers) { answers_ = answers; }
  std::uint64_t newest_id() const {
    const auto ids = received_.items();
    return ids.empty() ? 0 : *std::max_element(ids.begin(), ids.end());
  }
  Inbox<std::uint64_t> received_;  // ids of requests
  Inbox<msg::Command> commands_received_;

 private:
  void answer(std::uint64_t client, std::uint64_t id) {
    msg::CommandAck ack;
    ack.client(client);
    ack.id(id);
    ack.accepted(true);
    acks_.publish(ack);
  }
  std::atomic<bool> answers_;
  dds::Node node_;
  dds::Publisher<msg::CommandAck> acks_;
  dds::Publisher<msg::ControlStatus> statuses_;
  dds::Subscription commands_, missions_;
};

class Requests : public testing::Test {
 protected:
  std::future<Result> ask(std::chrono::milliseconds timeout) {
    return std::async(std::launch::async,
                      [this, timeout] { return client_.request(control::Request(), timeout); });
  }
  bool is_unanswered(std::future<Result> answer) { return answer.get().kind == Result::Kind::kSilence; }

  DomainLock lock_;
  Client client_{settings_of("ground", lock_)};
};

// GIVEN a controller that does not answer THEN a request is sent once, also a long mission, and again after the resend period of
// 2 s.
TEST_F(Requests, AreSentAgainAfterTheResendPeriodOnly) {
  Control control(lock_);
  control::Mission mission;
  mission.items.resize(control::kMaxMissionItems);
  const auto ids_of = [&](bool mission_wanted) {
    auto ids = control.received_.items();
    ids.erase(std::remove_if(ids.begin(), ids.end(),
                             [&](auto id) { return (id == client_.mission_id()) != mission_wanted; }),
              ids.end());
    return ids;
  };
  const auto since = Clock::now();
  std::future<Result> answer = ask(30s);
  EXPECT_EQ(client_.upload(mission, 1500ms).kind, Result::Kind::kSilence);
  ASSERT_TRUE(eventually([&] { return ids_of(false).size() == 2; }));
  EXPECT_GE(Clock::now() - since, 2000ms);
  EXPECT_EQ(ids_of(false).front(), ids_of(false).back());
  EXPECT_EQ(ids_of(true).size(), 1U);
  control.answers(true);
  EXPECT_TRUE(answer.get().accepted());
}

// The client sends again before its resend period when a restarted controller or a standby appears.
TEST_F(Requests, AreAnsweredByARestartedController) {
  auto first = std::make_unique<Control>(lock_);
  std::future<Result> answer = ask(10s);
  ASSERT_TRUE(first->received_.wait_for_count(1));
  const auto since = Clock::now();
  first.reset();
  Control second(lock_, true);
  EXPECT_TRUE(answer.get().accepted());
  EXPECT_LT(Clock::now() - since, 1500ms);
}

TEST_F(Requests, AreSentAgainAfterAFailover) {
  Control active(lock_, true);
  Control standby(lock_, true);
  std::uint64_t sequence = 1000;
  ASSERT_TRUE(eventually([&] {
    active.publish_status(++sequence);
    return ask(10s).get().accepted() && active.received_.size() > 0 && standby.received_.size() > 0 &&
           client_.view().control.seen();
  })) << "discovery incomplete";
  active.answers(false);
  standby.answers(false);
  // Earlier requests may still be in flight to the controller that did not answer them.
  const std::uint64_t before = std::max(active.newest_id(), standby.newest_id());
  const auto received_since = [before](std::ptrdiff_t times) {
    return [before, times](const auto& ids) {
      return std::count_if(ids.begin(), ids.end(), [before](auto id) { return id > before; }) == times;
    };
  };
  std::future<Result> answer = ask(1900ms);
  ASSERT_TRUE(active.received_.wait(received_since(1)));
  ASSERT_TRUE(standby.received_.wait(received_since(1)));
  active.publish_status(++sequence);
  standby.publish_status(1);
  EXPECT_TRUE(standby.received_.wait(received_since(2)));
  EXPECT_TRUE(is_unanswered(std::move(answer)));
  EXPECT_TRUE(received_since(2)(standby.received_.items()));
}

// One side may discover the reader before the other discovers the writer. A request sent in between must not
// wait for the resend period.
TEST_F(Requests, ReachAJustDiscoveredControllerWithoutDelay) {
  for (int round = 0; round < 10; ++round) {
    Control control(lock_, true);
    const auto since = Clock::now();
    ASSERT_TRUE(ask(10s).get().accepted()) << round;
    EXPECT_LT(Clock::now() - since, 1500ms) << round;
  }
}

// A height is upward, z of NED downward.
TEST_F(Requests, ToTakeOffContainTheHeightAsNegativeZ) {
  Control control(lock_, true);
  Vehicle vehicle(settings_of("pilot", lock_));
  ASSERT_TRUE(vehicle.take_off(1.5, 0.4).accepted());
  const msg::Command received = control.commands_received_.items().back();
  EXPECT_EQ(received.kind(), msg::Command_Constants::TAKEOFF);
  EXPECT_EQ(received.position_ned()[2], -1.5);
  EXPECT_EQ(received.speed(), 0.4);
}

// GIVEN a controller that is heard before it reads setpoints WHEN a program connects THEN its first setpoint reaches somebody.
TEST(Connection, IsThereWhenTheControllerReadsSetpoints) {
  const DomainLock lock;
  Control control(lock);
  Vehicle vehicle(settings_of("ground", lock));
  ASSERT_TRUE(eventually([&] {
    control.publish_status(1);
    return vehicle.connected();
  }));
  EXPECT_FALSE(vehicle.send(VelocitySetpoint{Eigen::Vector3d::Zero()}));
  auto connecting = std::async(std::launch::async, [&] { return vehicle.connect(60s); });
  EXPECT_EQ(connecting.wait_for(200ms), std::future_status::timeout) << "nobody reads setpoints";
  dds::Node late(settings_of("late", lock));
  const dds::Subscription setpoints =
      late.subscribe<msg::Setpoint>(messages::topics::kSetpoint, [](const auto&) {});
  EXPECT_TRUE(connecting.get().accepted());
  EXPECT_TRUE(vehicle.send(VelocitySetpoint{Eigen::Vector3d::Zero()}));
}

// GIVEN a controller whose messages have another version WHEN a program connects THEN it is told so at once, by a sentence.
TEST(Connection, ToAControllerOfAnotherWireVersionIsRefused) {
  const DomainLock lock;
  Control control(lock);
  control.publish_status(1, messages::kWireVersion + 1);
  Vehicle vehicle(settings_of("ground", lock));
  const Result refused = vehicle.connect(60s);
  EXPECT_EQ(refused.kind, Result::Kind::kNoControl);
  EXPECT_NE(refused.reason.find("control speaks version 4 of the messages, this program 3"),
            std::string::npos)
      << refused.reason;
  EXPECT_FALSE(vehicle.connected());
}

}  // namespace swiftlet::ground::client_test
