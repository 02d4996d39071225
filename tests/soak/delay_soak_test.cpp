// A short form of `./dev soak delay`.
#include <fstream>

#include <gtest/gtest.h>

#include "tests/soak/delay_flight.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

TEST(Delay, OfTwentyMillisecondsEachWayIsShownAndFlownWithGainsForIt) {
  if (const std::string why = tests::HostNetwork::why_unavailable(); !why.empty()) GTEST_SKIP() << why;
  const tests::TemporaryFolder folder;
  DelaySettings settings;
  settings.duplicated = 5;
  settings.mission = (folder.path() / "hop.yaml").string();
  std::ofstream(settings.mission) << "name: hop\nframe: ned\ntolerance_m: 0.1\nitems:\n"
                                     "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.5}\n"
                                     "  - {kind: waypoint, position_m: [0.5, 0, -0.5], speed_m_s: 0.5}\n"
                                     "  - {kind: land, speed_m_s: 0.5}\n";
  const DelayResult result = fly_with_delay(settings, folder.path());
  EXPECT_TRUE(result.good()) << result.flight.fault << "rms " << result.flight.rms_m << " m";
  EXPECT_TRUE(result.before.near_margin)
      << result.before.p95_s << " s, margin " << result.before.margin_s << " s";
  EXPECT_FALSE(result.after.near_margin)
      << result.after.p95_s << " s, margin " << result.after.margin_s << " s";
  EXPECT_GT(result.after.p50_s, 0.035);  // with jitter, newer commands overtake older ones
  EXPECT_LT(result.after.p50_s, 0.060);
  EXPECT_GT(result.overtaken, 100U);
  EXPECT_GT(result.duplicated, 100U);
}

}  // namespace
}  // namespace swiftlet::soak
