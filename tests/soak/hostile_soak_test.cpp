// A short form of `./dev soak hostile`.
#include <gtest/gtest.h>

#include "tests/soak/hostile_flight.hpp"
#include "tests/support/network_namespace.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

constexpr double kLargestDeviation_m = 0.05;
constexpr double kMemoryGrowth_mib = 16.0;

class Hostile : public testing::TestWithParam<bool> {};  // with a network key

TEST_P(Hostile, DatagramsDoNotDisturbAFlight) {
  if (const std::string why = tests::HostNetwork::why_unavailable(); !why.empty()) GTEST_SKIP() << why;
  const tests::TemporaryFolder folder;
  HostileSettings settings;
  settings.datagrams = 16'000;
  settings.per_second = 4'000;
  settings.network_key = GetParam();
  settings.forges = GetParam();  // only a key can tell
  const HostileResult result = fly_under_attack(settings, folder.path());
  EXPECT_GE(result.sent, settings.datagrams);
  EXPECT_TRUE(result.dead.empty()) << result.dead.front() << " ended";
  EXPECT_TRUE(result.mission_completed);
  EXPECT_LT(result.largest_deviation_m, kLargestDeviation_m);
  EXPECT_LT(result.memory_growth_mib, kMemoryGrowth_mib);
}

INSTANTIATE_TEST_SUITE_P(Over, Hostile, testing::Bool(),
                         [](const auto& of) { return of.param ? "ForgedToo" : "Changed"; });

}  // namespace
}  // namespace swiftlet::soak
