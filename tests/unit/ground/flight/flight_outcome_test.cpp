#include "swiftlet/ground/flight/flight_outcome.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace swiftlet::ground::flight_outcome_test {

constexpr std::int64_t kSample_ns = 10'000'000;  // period of telemetry
constexpr int kSamples = 1000;

// Report of a 10 s flight whose truth deviates from its reference by error(i) m north, with `samples` samples
// of telemetry.
analysis::FlightReport judged(const std::function<double(int)>& error, int samples = kSamples,
                              const std::string& reason = "") {
  record::Evaluation flown;
  flown.window = record::Window{0, kSamples * kSample_ns};
  record::Flight flight;
  for (int i = 0; i < samples; ++i) {
    record::ReferenceRow reference;
    reference.stamp_ns = i * kSample_ns;
    reference.position_ned = {0.01 * i, 0.5, -1.0};
    record::TruthRow truth;
    truth.stamp_ns = reference.stamp_ns;
    truth.position_ned = {reference.position_ned[0] + error(i), 0.5, -1.0};
    flight.reference.push_back(reference);
    flight.truth.push_back(truth);
  }
  analysis::FlightReport report;
  report.tolerance_m = 0.1;
  report.reason = reason;
  flown.errors = record::tracking_errors(flight.truth, flight.reference, *flown.window);
  judge(report, flown);
  return report;
}

TEST(Judge, CompletesAFlightWithinTolerance) {
  const analysis::FlightReport report = judged([](int) { return 0.099; });
  EXPECT_TRUE(report.completed);
  EXPECT_EQ(report.reason, "");
  EXPECT_NEAR(report.errors.peak_3d_m, 0.099, 1e-12);
}

// One sample of 0.2 m among 999 of 0.01 m has an RMS of 0.012 m, far below the tolerance.
TEST(Judge, FailsOnOneSampleBeyondTolerance) {
  const analysis::FlightReport report = judged([](int i) { return i == 700 ? -0.2 : 0.01; });
  EXPECT_LT(report.errors.rms_3d_m, 0.02);
  EXPECT_FALSE(report.completed);
  EXPECT_EQ(report.reason, "the peak tracking error was 0.200 m, the tolerance is 0.100 m");
}

TEST(Judge, KeepsTheReasonThatEndedTheFlight) {
  const analysis::FlightReport report = judged([](int) { return 0.5; }, kSamples, "the vehicle is silent");
  EXPECT_FALSE(report.completed);
  EXPECT_EQ(report.reason, "the vehicle is silent");
  EXPECT_NEAR(report.errors.peak_3d_m, 0.5, 1e-12) << "the errors are still evaluated";
}

TEST(Judge, FailsWithoutTelemetryToTheEnd) {
  const analysis::FlightReport report = judged([](int) { return 0.0; }, kSamples - 30);
  EXPECT_FALSE(report.completed);
  EXPECT_NE(report.reason.find("too little telemetry"), std::string::npos) << report.reason;
  EXPECT_FALSE(judged([](int) { return 0.0; }, 0).completed);
}

TEST(Judge, FailsOnAGroundTruthThatIsNotFinite) {
  const analysis::FlightReport report =
      judged([](int i) { return i == 5 ? std::numeric_limits<double>::quiet_NaN() : 0.0; });
  EXPECT_FALSE(report.completed);
  EXPECT_EQ(report.reason, "the ground truth is not finite");
}

}  // namespace swiftlet::ground::flight_outcome_test
