// A short form of `./dev soak hostile`: each kind of attack on a flight of its own.

#include <gtest/gtest.h>

#include "tests/soak/hostile_flight.hpp"
#include "tests/support/network/network_namespace.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

constexpr double kLargestDeviation_m = 0.05;
constexpr double kMemoryGrowth_mib = 16.0;

TEST(Hostile, DatagramsEndNoProcessAndWithAKeyDisturbNoFlight) {
  if (const std::string why = tests::HostNetwork::why_unavailable(); !why.empty()) GTEST_SKIP() << why;
  HostileSettings settings;
  settings.datagrams = 16'000;
  settings.per_second = 4'000;
  settings.baseline_s = 0.5;
  for (const bool forges : {false, true}) {
    SCOPED_TRACE(forges ? "changed and forged, with a network key" : "changed");
    settings.network_key = settings.forges = forges;
    const tests::TemporaryFolder folder;
    const HostileResult result = fly_under_attack(settings, folder.path());
    EXPECT_GE(result.sent, settings.datagrams);
    EXPECT_TRUE(result.dead.empty()) << result.dead.front() << " ended";
    EXPECT_LT(result.memory_growth_mib, kMemoryGrowth_mib);
    if (!settings.network_key) continue;
    EXPECT_TRUE(result.mission_completed);
    EXPECT_LT(result.largest_deviation_m, kLargestDeviation_m);
  }
}

}  // namespace
}  // namespace swiftlet::soak
