// A process asks the vehicle for its clock.
#include "swiftlet/services/clocks/clock_client.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "swiftlet/services/clocks/clock_server.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/private_domain.hpp"

namespace swiftlet::clocks::clock_client_test {

using swiftlet::tests::eventually;
using swiftlet::tests::Inbox;

constexpr std::int64_t kOffset_ns = 1'000'000'000'000;  // the vehicle's clock minus the own

std::int64_t own_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

class Clocks : public testing::Test {
 protected:
  const dds::DomainLock lock_;
  dds::Node vehicle_{swiftlet::tests::settings_of("plant", lock_)};
  dds::Node asking_{swiftlet::tests::settings_of("mocap", lock_)};
};

TEST_F(Clocks, AreTranslated) {
  const ClockServer server(vehicle_, [] { return own_ns() + kOffset_ns; });
  ClockClient client(asking_, own_ns);
  EXPECT_EQ(client.to_vehicle(0), std::nullopt);
  const std::int64_t stamp_ns = own_ns();
  ASSERT_TRUE(eventually([&] {
    client.ask_if_due();
    return client.to_vehicle(stamp_ns).has_value();
  }));
  EXPECT_LT(std::abs(*client.to_vehicle(stamp_ns) - stamp_ns - kOffset_ns), kLongestExchangeNs);
}

// GIVEN a stranger that asks with the number of the client, and with the highest sequence number, before each of its
// requests is answered THEN the client still takes the answers to its own.
TEST_F(Clocks, AreTranslatedAlthoughAStrangerAsksInTheNameOfTheClient) {
  auto replies = vehicle_.publish(messages::topics::kClockReply);
  const auto requests = vehicle_.subscribe<messages::msg::ClockRequest>(
      messages::topics::kClockRequest, [&](const messages::msg::ClockRequest& request) {
        messages::msg::ClockReply reply;
        reply.client(request.client());
        reply.sent_ns(request.sent_ns());
        reply.received_ns(own_ns() + kOffset_ns);
        reply.answered_ns(reply.received_ns());
        for (const auto number : {std::numeric_limits<std::uint64_t>::max(), request.sequence_number()}) {
          reply.sequence_number(number);
          replies.publish(reply);
        }
      });
  ClockClient client(asking_, own_ns);
  EXPECT_TRUE(eventually([&] {
    client.ask_if_due();
    return client.to_vehicle(own_ns()).has_value();
  }));
}

// GIVEN a vehicle's clock that does not run at the first request THEN that is not answered, and the next one is.
TEST_F(Clocks, AnswerWhileTheyRun) {
  std::atomic<std::int64_t> readings{-1};
  const ClockServer server(vehicle_, [&]() -> std::optional<std::int64_t> {
    const std::int64_t reading = ++readings;
    return reading == 0 ? std::nullopt : std::optional(reading);
  });
  Inbox<messages::msg::ClockReply> replies;
  const dds::Subscription subscription = asking_.subscribe<messages::msg::ClockReply>(
      messages::topics::kClockReply, [&](const messages::msg::ClockReply& reply) { replies.put(reply); });
  auto requests = asking_.publish(messages::topics::kClockRequest);
  messages::msg::ClockRequest request;
  request.client(7);
  request.sent_ns(42);
  ASSERT_TRUE(eventually([&] {
    request.sequence_number(request.sequence_number() + 1);
    requests.publish(request);
    return replies.size() > 0;
  }));
  const messages::msg::ClockReply reply = replies.items().front();
  EXPECT_EQ(reply.client(), 7U);
  EXPECT_GT(reply.sequence_number(), 1U);
  EXPECT_EQ(reply.sent_ns(), 42);
  EXPECT_LT(reply.received_ns(), reply.answered_ns());
  EXPECT_GT(reply.received_ns(), 0);
}

}  // namespace swiftlet::clocks::clock_client_test
