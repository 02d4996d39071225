// A short form of `./dev soak loss`.
#include <fstream>

#include <gtest/gtest.h>

#include "tests/soak/loss_flight.hpp"
#include "tests/support/network/network_namespace.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

// Twice that of the same flight without losses: its take-off is a large part of it.
constexpr double kLargestRmsOfAHop_m = 0.010;

TEST(Loss, OfFifteenPercentAtEachHostDoesNotDisturbAFlight) {
  if (const std::string why = tests::HostNetwork::why_unavailable(); !why.empty()) GTEST_SKIP() << why;
  const tests::TemporaryFolder folder;
  LossSettings settings;
  settings.percent = 15;
  settings.waypoints = 400;
  settings.mission = (folder.path() / "hop.yaml").string();
  std::ofstream(settings.mission) << "name: hop\nframe: ned\ntolerance_m: 0.1\nitems:\n"
                                     "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.5}\n"
                                     "  - {kind: waypoint, position_m: [0.5, 0, -0.5], speed_m_s: 0.5}\n"
                                     "  - {kind: land, speed_m_s: 0.5}\n";
  const LossResult result = fly_with_losses(settings, folder.path());
  EXPECT_GE(result.upload_s, 0.0) << result.fault;
  EXPECT_GE(result.clear_s, 0.0) << result.fault;
  EXPECT_TRUE(result.flight.completed) << result.fault;
  EXPECT_LT(result.flight.rms_m, kLargestRmsOfAHop_m);
}

}  // namespace
}  // namespace swiftlet::soak
