// A short form of `./dev soak hostile`.
#include <ostream>

#include <gtest/gtest.h>

#include "tests/soak/hostile_flight.hpp"
#include "tests/support/network_namespace.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

constexpr double kLargestDeviation_m = 0.05;
constexpr double kMemoryGrowth_mib = 16.0;

struct Attack {
  const char* name;
  tests::AttackTransport transport;
  bool forges;  // the flight has a network key then: only a key can tell
};

void PrintTo(const Attack& attack, std::ostream* out) { *out << attack.name; }

class Hostile : public testing::TestWithParam<Attack> {};

TEST_P(Hostile, DatagramsDoNotDisturbAFlight) {
  if (const std::string why = tests::HostNetwork::why_unavailable(); !why.empty()) GTEST_SKIP() << why;
  const tests::TemporaryFolder folder;
  HostileSettings settings;
  settings.datagrams = 16'000;
  settings.per_second = 4'000;
  settings.transport = GetParam().transport;
  settings.network_key = GetParam().forges;
  settings.forges = GetParam().forges;
  const HostileResult result = fly_under_attack(settings, folder.path());
  EXPECT_GE(result.sent, settings.datagrams);
  EXPECT_TRUE(result.dead.empty()) << result.dead.front() << " ended";
  EXPECT_TRUE(result.mission_completed);
  EXPECT_LT(result.largest_deviation_m, kLargestDeviation_m);
  EXPECT_LT(result.memory_growth_mib, kMemoryGrowth_mib);
}

INSTANTIATE_TEST_SUITE_P(Over, Hostile,
                         testing::Values(Attack{"Changed", tests::AttackTransport::kUdp, false},
                                         Attack{"ForgedToo", tests::AttackTransport::kUdp, true},
                                         Attack{"SharedMemory", tests::AttackTransport::kSharedMemory,
                                                false}),
                         [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace swiftlet::soak
