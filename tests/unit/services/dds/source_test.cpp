// Sources of a topic: a second process that is to be the source is refused, and a subscription with one source
// keeps to it.
#include <algorithm>
#include <future>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/discovery/sole_source.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "tests/support/eventually.hpp"
#include "tests/unit/services/messages/messages.hpp"

namespace swiftlet::dds::fixtures::source_test {

using swiftlet::tests::eventually;
using swiftlet::tests::Inbox;
using namespace std::chrono_literals;

class Sources : public testing::Test {
 protected:
  NodeSettings settings(const char* name, const char* source_of, const char* vehicle = "kl1") const {
    NodeSettings settings;
    settings.name = name;
    settings.vehicle = vehicle;
    settings.domain = lock_.domain();
    settings.source_of = source_of;
    return settings;
  }
  std::string lives(const std::string& process) const {
    char host[256] = {};
    ::gethostname(host, sizeof host - 1);
    return "vehicle kl1 is already in use in domain " + std::to_string(lock_.domain()) + ": " + process +
           " (process " + std::to_string(::getpid()) + " on host " + host + ") publishes its imu";
  }

  // Why a new process may not become the source; "" if it may. A busy machine may discover the other process only
  // after the search has ended.
  std::string refusal_of(const NodeSettings& second) const {
    std::string refusal;
    eventually([&] {
      Node node(second);
      refusal = node.become_source().value_or("");
      return !refusal.empty();
    });
    return refusal;
  }

  DomainLock lock_;
};

TEST_F(Sources, ASecondOneIsRefusedAndNamesTheFirstUntilThatHasLeft) {
  auto first = std::make_unique<Node>(settings("plant", "imu"));
  EXPECT_EQ(first->become_source(), std::nullopt);
  EXPECT_EQ(refusal_of(settings("impostor", "imu")), lives("plant"));
  first->rejoin();
  EXPECT_EQ(refusal_of(settings("impostor", "imu")), lives("plant")) << "after a rejoin";
  first.reset();
  Node second(settings("plant", "imu"));
  EXPECT_EQ(second.become_source(), std::nullopt);
}

TEST_F(Sources, OfOtherVehiclesAndTopicsDoNotExcludeEachOther) {
  Node plant(settings("plant", "imu"));
  Node mocap(settings("mocap", "mocap_pose"));
  Node other(settings("plant", "imu", "kl2"));
  std::vector<std::future<std::optional<std::string>>> refusals;
  for (Node* const node : {&plant, &mocap, &other})
    refusals.push_back(std::async(std::launch::async, [node] { return node->become_source(); }));
  for (auto& refusal : refusals) EXPECT_EQ(refusal.get(), std::nullopt);
}

TEST_F(Sources, ExactlyOneOfTwoThatStartAtOnceIsRefused) {
  Node first(settings("first", "imu"));
  Node second(settings("second", "imu"));
  auto other_of_first = std::async(std::launch::async, [&] { return first.become_source(); });
  Inbox<std::string> lost;
  auto other_of_second = second.become_source([&](const std::string& sentence) { lost.put(sentence); });
  EXPECT_EQ(other_of_first.get(), std::nullopt) << "it joined earlier";
  if (!other_of_second && lost.wait_for_count(1)) other_of_second = lost.items().front();
  EXPECT_EQ(other_of_second, lives("first"));
}

TEST_F(Sources, AProgramThatAnnouncesNothingExcludesASecondOne) {
  Node vehicle(settings("vehicle of another make", ""));
  const auto imu = vehicle.publish(messages::topics::kImu);
  EXPECT_EQ(refusal_of(settings("plant", "imu")), lives("vehicle of another make"));
}

TEST_F(Sources, EndAProcessThatIsNotTheFirst) {
  Participant first(settings("plant", "imu"), {"kl1"});
  const SoleSource source(first, "imu", [] {});
  EXPECT_NO_THROW(source.check());
  std::string refusal;
  eventually([&] {
    Participant second(settings("impostor", "imu"), {"kl7", "kl1"});
    try {
      const SoleSource refused(second, "imu", [] {});
    } catch (const std::runtime_error& error) {
      refusal = error.what();
    }
    return !refusal.empty();
  });
  EXPECT_EQ(refusal, lives("plant") + "; choose another --vehicle-name or --domain");
}

TEST_F(Sources, AVehicleIsFreeWhenItsLastNodeHasEnded) {
  Participant plant(settings("plant", "imu"), {"kl1", "kl2"});
  auto first = std::make_unique<Node>(plant, "kl1");
  const Node second(plant, "kl2");
  ASSERT_EQ(plant.become_source({"imu"}), std::nullopt);
  ASSERT_EQ(refusal_of(settings("impostor", "imu")), lives("plant"));
  first.reset();
  EXPECT_TRUE(eventually([&] { return !Node(settings("plant", "imu")).become_source(); }));
  EXPECT_NE(refusal_of(settings("impostor", "imu", "kl2")), "");
}

TEST_F(Sources, AReservedFlightExcludesAnotherAndLivingVehicles) {
  const NodeSettings network = settings("ground", "");
  const auto refusal_of_flight = [&](const std::vector<std::string>& vehicles) -> std::string {
    try {
      const FlightReservation reservation(network, vehicles);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return {};
  };
  const auto is_refused = [&](const std::vector<std::string>& vehicles, const char* sentence) {
    return eventually([&] { return refusal_of_flight(vehicles).find(sentence) != std::string::npos; });
  };
  {
    const FlightReservation reservation(network, {"kl1", "kl2"});
    EXPECT_EQ(refusal_of_flight({"kl3"}), "");
    EXPECT_TRUE(is_refused({"kl3", "kl2"}, "vehicle kl2 is already in use in domain "));
    Node plant(settings("plant", "imu"));
    EXPECT_EQ(plant.become_source(), std::nullopt) << "the flight starts its own processes";
    EXPECT_TRUE(is_refused({"kl1"}, "vehicle kl1 is already in use in domain "));
  }
  EXPECT_EQ(refusal_of_flight({"kl1"}), "");
  Node mocap(settings("mocap", "mocap_pose"));
  EXPECT_EQ(mocap.become_source(), std::nullopt);
  EXPECT_TRUE(is_refused({"kl1"}, "mocap (process "));
}

// It has another participant then, in the same process.
TEST_F(Sources, StayTheSourceOfASubscriptionAfterARejoin) {
  Node plant(settings("plant", "imu"));
  Node control(settings("control", ""));
  Inbox<std::uint64_t> received;
  std::atomic<int> others{0};
  const auto subscription = control.subscribe<messages::msg::Imu>(
      messages::topics::kImu, [&](const messages::msg::Imu& imu) { received.put(imu.sequence_number()); },
      Delivery::kShared, OneSource{1h, [&] { ++others; }});
  auto publisher = plant.publish(messages::topics::kImu);
  messages::msg::Imu imu = messages::fixtures::example<messages::msg::Imu>();
  const auto receives = [&](std::uint64_t number) {
    imu.sequence_number(number);
    return eventually([&] {
      publisher.publish(imu);
      const auto items = received.items();
      return std::find(items.begin(), items.end(), number) != items.end();
    });
  };
  ASSERT_TRUE(receives(1));
  plant.rejoin();
  EXPECT_TRUE(receives(2));
  EXPECT_EQ(subscription.source_conflict().has_value(), false);
  EXPECT_EQ(others, 0) << "it is the same process";
}

TEST(Interfaces, NameTheLoopbackInterface) {
  EXPECT_EQ(io::interfaces_text(true), "lo (127.0.0.1)");
  EXPECT_NE(io::interfaces_text(false).find("lo (127.0.0.1)"), std::string::npos);
}

}  // namespace swiftlet::dds::fixtures::source_test
