// Signals of the ground to a vehicle beside requests: heartbeat and simulation clock.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/ground/client/ground_heartbeat.hpp"
#include "swiftlet/ground/client/simulation_clock.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"

namespace swiftlet::ground::ground_signals_test {

namespace msg = messages::msg;
using tests::eventually;
using tests::Inbox;

constexpr std::int64_t kMs = 1'000'000;

class GroundSignals : public testing::Test {
 protected:
  static dds::NodeSettings settings(const dds::DomainLock& lock, const char* name) {
    dds::NodeSettings settings;
    settings.name = name;
    settings.domain = lock.domain();
    return settings;
  }
  dds::DomainLock lock_;
  dds::Node ground_{settings(lock_, "ground")};
  dds::Node vehicle_{settings(lock_, "vehicle")};
};

TEST_F(GroundSignals, HeartbeatIsSentEvery50MsOfTheVehiclesClock) {
  Inbox<msg::GroundLink> inbox;
  const auto subscription = vehicle_.subscribe<msg::GroundLink>(
      messages::topics::kGroundLink, [&](const msg::GroundLink& heartbeat) { inbox.put(heartbeat); });
  GroundHeartbeatPublisher publisher(ground_, 42);
  // Heartbeats are lost until both sides have found each other.
  std::int64_t found_ms = 0;
  ASSERT_TRUE(eventually([&] {
    publisher.telemetry((found_ms += 50) * kMs);
    return inbox.size() > 0;
  }));
  // A new heartbeat replaces one that was not sent yet, so the test waits for each.
  const auto arrives = [&](std::int64_t ms) {
    return inbox.wait([=](const auto& all) { return !all.empty() && all.back().stamp_ns() == ms * kMs; });
  };
  publisher.telemetry(1'000'000 * kMs);
  ASSERT_TRUE(arrives(1'000'000));
  inbox.clear();
  for (std::int64_t t = 1'000'010; t <= 1'000'150; t += 10) {
    publisher.telemetry(t * kMs);
    if (t % 50 == 0) {
      ASSERT_TRUE(arrives(t)) << t;
    }
  }
  publisher.telemetry(100 * kMs);
  ASSERT_TRUE(arrives(100)) << "after a restart of the vehicle";
  std::vector<std::int64_t> stamps;
  for (const msg::GroundLink& heartbeat : inbox.items()) {
    EXPECT_EQ(heartbeat.client(), 42U);
    EXPECT_TRUE(heartbeat.depends());
    stamps.push_back(heartbeat.stamp_ns() / kMs);
  }
  EXPECT_EQ(stamps, (std::vector<std::int64_t>{1'000'050, 1'000'100, 1'000'150, 100}));
}

// 100 ms ahead of the time reached, in steps of 25 ms, and never beyond the goal.
TEST_F(GroundSignals, SimulationClockRunsOneWindowAheadUpToTheGoal) {
  Inbox<std::int64_t> simulation_clock;
  const auto subscription = vehicle_.subscribe<msg::SimulationClock>(
      messages::topics::kSimulationClock,
      [&](const msg::SimulationClock& clock) { simulation_clock.put(clock.advance_to_ns() / kMs); });
  SimulationClockPublisher clock(ground_, 100 * kMs);
  ASSERT_TRUE(eventually([&] { return subscription.matched() == 1; }));
  const auto arrives = [&](std::int64_t ms) {
    return simulation_clock.wait(
        [=](const auto& all) { return std::find(all.begin(), all.end(), ms) != all.end(); });
  };
  clock.up_to(1'000 * kMs);
  ASSERT_TRUE(arrives(100));
  clock.has_come(10 * kMs);  // too small a step for a message
  clock.has_come(30 * kMs);
  ASSERT_TRUE(arrives(130));
  const std::vector<std::int64_t> so_far = simulation_clock.items();
  EXPECT_EQ(std::count(so_far.begin(), so_far.end(), 110), 0);
  clock.has_come(20 * kMs);  // out of order
  clock.up_to(500 * kMs);    // the goal does not go back
  clock.has_come(950 * kMs);
  ASSERT_TRUE(arrives(1'000));
  clock.has_come(3'000 * kMs);
  simulation_clock.clear();
  ASSERT_TRUE(simulation_clock.wait_for_count(2)) << "the last message is repeated for late subscribers";
  const std::vector<std::int64_t> again = simulation_clock.items();
  EXPECT_EQ(std::count(again.begin(), again.end(), 1'000), static_cast<std::ptrdiff_t>(again.size()));
  clock.without_end();
  ASSERT_TRUE(arrives(3'100));
}

}  // namespace swiftlet::ground::ground_signals_test
