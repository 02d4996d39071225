// How often a request goes out, and that whoever acts answers it. The control service is the test.
#include "swiftlet/ground/client/client.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"

namespace swiftlet::ground {
namespace {

using comms::DomainLock;
using tests::eventually;
using tests::Inbox;
using namespace std::chrono_literals;

comms::NodeSettings settings_of(const char* name, const DomainLock& lock) {
  comms::NodeSettings settings;
  settings.name = name;
  settings.domain = lock.domain();
  settings.localhost_only = true;
  return settings;
}

// Hears requests, and answers if it is to.
class Control {
 public:
  explicit Control(const DomainLock& lock, bool answers = false)
      : answers_(answers),
        node_(settings_of("control", lock)),
        acks_(node_.publish(comms::topics::kCommandAck)),
        statuses_(node_.publish(comms::topics::kControlStatus)) {
    commands_ = node_.subscribe<msg::Command>(comms::topics::kCommand, [this](const msg::Command& command) {
      heard_.put(command.id());
      if (answers_) answer(command.client(), command.id());
    });
    missions_ = node_.subscribe<msg::Mission>(
        comms::topics::kMission, [this](const msg::Mission& mission) { heard_.put(mission.id()); });
  }
  void say(std::uint64_t sequence_number) {
    msg::ControlStatus status;
    status.sequence_number(sequence_number);
    statuses_.publish(status);
  }
  void answers(bool answers) { answers_ = answers; }
  std::uint64_t newest() const {
    const auto ids = heard_.items();
    return ids.empty() ? 0 : *std::max_element(ids.begin(), ids.end());
  }
  Inbox<std::uint64_t> heard_;  // ids of requests

 private:
  void answer(std::uint64_t client, std::uint64_t id) {
    msg::CommandAck ack;
    ack.client(client);
    ack.id(id);
    ack.accepted(true);
    acks_.publish(ack);
  }
  std::atomic<bool> answers_;
  comms::Node node_;
  comms::Publisher<msg::CommandAck> acks_;
  comms::Publisher<msg::ControlStatus> statuses_;
  comms::Subscription commands_, missions_;
};

class Requests : public testing::Test {
 protected:
  std::future<Result> ask(std::chrono::milliseconds timeout) {
    return std::async(std::launch::async, [this, timeout] {
      msg::Command hold;
      hold.kind(msg::Command_Constants::HOLD);
      return client_.command(hold, timeout);
    });
  }
  bool is_silence(std::future<Result> answer) { return answer.get().kind == Result::Kind::kSilence; }

  DomainLock lock_;
  Client client_{settings_of("ground", lock_)};
};

TEST_F(Requests, GoOutOnceWhileNobodyAnswers) {
  Control control(lock_);
  EXPECT_TRUE(is_silence(ask(1500ms)));
  EXPECT_EQ(control.heard_.size(), 1U);
}

TEST_F(Requests, ALongMissionGoesOutOnce) {
  Control control(lock_);
  control::Mission mission;
  mission.items.resize(control::kMaxMissionItems);
  EXPECT_EQ(client_.upload(mission, 1900ms).kind, Result::Kind::kSilence);
  EXPECT_EQ(control.heard_.size(), 1U);
}

TEST_F(Requests, GoOutAgainAfterALongSilence) {
  Control control(lock_);
  EXPECT_TRUE(is_silence(ask(3500ms)));
  EXPECT_EQ(control.heard_.size(), 2U);
  const auto ids = control.heard_.items();
  EXPECT_EQ(ids.front(), ids.back());
}

// Well before the silence is long: a controller that was started again, a standby that took over.
TEST_F(Requests, AreAnsweredByAControllerThatIsStartedMeanwhile) {
  auto first = std::make_unique<Control>(lock_);
  std::future<Result> answer = ask(10s);
  ASSERT_TRUE(first->heard_.wait_for_count(1));
  const auto since = Clock::now();
  first.reset();
  Control second(lock_, true);
  EXPECT_TRUE(answer.get().accepted());
  EXPECT_LT(Clock::now() - since, 1500ms);
}

TEST_F(Requests, GoOutAgainWhenAnotherControllerTakesOver) {
  Control active(lock_, true);
  Control standby(lock_, true);
  std::uint64_t sequence = 1000;
  ASSERT_TRUE(eventually([&] {
    active.say(++sequence);
    return ask(10s).get().accepted() && active.heard_.size() > 0 && standby.heard_.size() > 0 &&
           client_.view().control.seen();
  })) << "they all know each other";
  active.answers(false);
  standby.answers(false);
  // Those of before may still be on their way to the one that did not answer them.
  const std::uint64_t before = std::max(active.newest(), standby.newest());
  const auto heard_since = [before](std::ptrdiff_t times) {
    return [before, times](const auto& ids) {
      return std::count_if(ids.begin(), ids.end(), [before](auto id) { return id > before; }) == times;
    };
  };
  std::future<Result> answer = ask(1900ms);
  ASSERT_TRUE(active.heard_.wait(heard_since(1)));
  ASSERT_TRUE(standby.heard_.wait(heard_since(1)));
  active.say(++sequence);
  standby.say(1);
  EXPECT_TRUE(standby.heard_.wait(heard_since(2)));
  EXPECT_TRUE(is_silence(std::move(answer)));
  EXPECT_TRUE(heard_since(2)(standby.heard_.items()));
}

// A reader may be known to the one before the writer is known to the other: what is sent then must not wait
// for the long silence.
TEST_F(Requests, ReachAControllerThatWasJustFound) {
  for (int round = 0; round < 10; ++round) {
    Control control(lock_, true);
    const auto since = Clock::now();
    ASSERT_TRUE(ask(10s).get().accepted()) << round;
    EXPECT_LT(Clock::now() - since, 1500ms) << round;
  }
}

}  // namespace
}  // namespace swiftlet::ground
