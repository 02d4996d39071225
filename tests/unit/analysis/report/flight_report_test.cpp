#include "swiftlet/analysis/report/flight_report.hpp"

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace swiftlet::analysis::flight_report_test {

FlightReport flown_report() {
  FlightReport report;
  report.completed = true;
  report.mission = "square";
  report.vehicle = "KayLion";
  report.control = "motor_lag";
  report.seed = 7;
  report.record_dir = "flights/x";
  report.duration_s = 40.5;
  report.tolerance_m = 0.1;
  report.errors.rms_m = {0.001, 0.002, 0.003};
  report.errors.peak_m = {0.004, 0.005, 0.006};
  report.errors.rms_3d_m = 0.00374;
  report.errors.peak_3d_m = 0.0087;
  report.errors.matched = 18000;
  report.control_rate_hz = 500.0;
  report.cycles = 20000;
  report.deadline_misses = 3;
  report.sense_to_actuate = {90.0, 200.0, 900.0};
  return report;
}

TEST(FlightReportJson, HasTheDocumentedKeys) {
  const nlohmann::ordered_json json = to_json(flown_report());
  EXPECT_EQ(json.at("completed"), true);
  EXPECT_FALSE(json.contains("reason"));
  EXPECT_EQ(json.at("mission"), "square");
  EXPECT_EQ(json.at("vehicle"), "KayLion");
  EXPECT_EQ(json.at("control"), "motor_lag");
  EXPECT_EQ(json.at("seed"), 7);
  EXPECT_EQ(json.at("record_dir"), "flights/x");
  EXPECT_EQ(json.at("duration_s"), 40.5);
  EXPECT_EQ(json.at("rms_3d_m"), 0.00374);
  EXPECT_EQ(json.at("peak_3d_m"), 0.0087);
  EXPECT_EQ(json.at("rms_m").at("y"), 0.002);
  EXPECT_EQ(json.at("peak_m").at("z"), 0.006);
  EXPECT_EQ(json.at("control_rate_hz"), 500.0);
  EXPECT_EQ(json.at("deadline_misses"), 3);
  EXPECT_EQ(json.at("sense_to_actuate_us").at("p50"), 90.0);
  EXPECT_EQ(json.at("sense_to_actuate_us").at("p99"), 200.0);
  EXPECT_EQ(json.at("sense_to_actuate_us").at("max"), 900.0);
}

TEST(FlightReportJson, GivesTheReasonOfAFailedFlight) {
  FlightReport report = flown_report();
  report.completed = false;
  report.reason = "swiftlet-plant was killed";
  EXPECT_EQ(to_json(report).at("reason"), "swiftlet-plant was killed");
}

TEST(FlightReportJson, IsNullWhereNothingWasMeasured) {
  FlightReport report;
  report.errors.rms_3d_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(nlohmann::json::parse(to_json(report).dump()).at("rms_3d_m"), nullptr);
}

TEST(FlightReportText, ShowsErrorsInMillimetres) {
  const std::string text = to_text(flown_report());
  EXPECT_NE(text.find("square: completed"), std::string::npos) << text;
  EXPECT_NE(text.find("3.74"), std::string::npos) << text;
  EXPECT_NE(text.find("(tolerance 100)"), std::string::npos) << text;
  EXPECT_NE(text.find("3 of 20000 steps late"), std::string::npos) << text;
  EXPECT_NE(text.find("p50 90 us, p99 200 us, max 900 us"), std::string::npos) << text;
}

TEST(FlightReportText, Warns) {
  FlightReport report = flown_report();
  EXPECT_FALSE(to_json(report).contains("warnings"));
  report.warnings = {"air.wind_ned_m_s has no effect: drag is 0"};
  EXPECT_EQ(to_json(report).at("warnings").at(0), report.warnings.front());
  EXPECT_NE(to_text(report).find("  warning           air.wind_ned_m_s has no effect: drag is 0\n"),
            std::string::npos);
}

TEST(FlightReportText, OmitsFiguresThatWereNotMeasured) {
  FlightReport report;
  report.mission = "square";
  report.reason = "swiftlet-plant cannot be started";
  const std::string text = to_text(report);
  EXPECT_NE(text.find("NOT completed: swiftlet-plant cannot be started"), std::string::npos) << text;
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
  EXPECT_EQ(text.find("tracking"), std::string::npos) << text;
}

}  // namespace swiftlet::analysis::flight_report_test
