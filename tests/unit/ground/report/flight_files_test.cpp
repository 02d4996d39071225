#include "swiftlet/ground/report/flight_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/services/runtime/child_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;

class FlightFilesTest : public testing::Test {
 protected:
  tests::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> list;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) list.push_back(cell);
  if (!line.empty() && line.back() == ',') list.emplace_back();
  return list;
}

std::vector<std::vector<std::string>> table(const fs::path& file) {
  std::vector<std::vector<std::string>> rows;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) rows.push_back(cells(line));
  return rows;
}

// Truth at 500 Hz, and a reference with every fifth sample up to `last_reference`.
FlightRecord& fly(FlightRecord& record, int count, int last_reference) {
  for (int i = 0; i < count; ++i) {
    TruthRow truth;
    truth.stamp_ns = 1'000'000'000 + i * 2'000'000LL;
    truth.position_ned = {0.5 + 0.001 * i, 0.25, -1.0};
    truth.rotor_count = 4;
    truth.rotor_speeds = {1600, 1601, 1602, 1603};
    truth.supply_voltage_v = 4.1;
    record.truth.append(truth);
    if (i % 5 != 0 || i > last_reference) continue;
    ReferenceRow reference;
    reference.stamp_ns = truth.stamp_ns;
    reference.mode = 4;
    reference.position_ned = {0.501 + 0.001 * i, 0.25, -1.0};
    record.reference.append(reference);
  }
  return record;
}

TEST_F(FlightFilesTest, CsvHasARowForEachReferenceAndForLaterTruth) {
  FlightRecord record(100);
  write_flight_csv(folder_ / "flight.csv", fly(record, 30, 10), {1'010'000'000, 1'100'000'000});
  const auto rows = table(folder_ / "flight.csv");
  ASSERT_EQ(rows.size(), 6U) << "header, references at 0, 10 and 20 ms, truth alone at 36 and 52 ms";
  const auto& header = rows.front();
  for (const auto& row : rows) EXPECT_EQ(row.size(), header.size());
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
  };
  EXPECT_EQ(rows[1][column("t")], "-0.010000") << "t = 0 is the window's start";
  EXPECT_EQ(rows[3][column("px")], "0.51");
  EXPECT_EQ(rows[3][column("ref_px")], "0.511");
  EXPECT_EQ(rows[3][column("mode")], "4");
  EXPECT_EQ(rows[3][column("est_px")], "") << "no estimate with this stamp";
  EXPECT_EQ(rows[3][column("v_s")], "4.1");
  EXPECT_EQ(rows[3][column("om4")], "1603");
  EXPECT_EQ(rows[4][column("t")], "0.026000");
  EXPECT_EQ(rows[4][column("ref_px")], "") << "no reference with this stamp";
  EXPECT_EQ(rows[5][column("t")], "0.042000");
}

TEST_F(FlightFilesTest, DrawsAPicture) {
  ASSERT_FALSE(find_program("gnuplot").empty()) << "install the packages of packages.txt";
  FlightRecord record(2000);
  const Window window = {1'000'000'000, 3'000'000'000};
  write_flight_csv(folder_ / "flight.csv", fly(record, 1000, 1000), window);
  FlightReport report;
  report.mission = "it's_a 'square'";  // must be escaped for gnuplot
  report.duration_s = 2.0;
  EXPECT_EQ(draw_flight(folder_, report, window), "");
  std::ifstream picture(folder_ / "flight.png", std::ios::binary);
  std::string magic(8, '\0');
  picture.read(magic.data(), 8);
  EXPECT_EQ(magic, "\x89PNG\r\n\x1a\n");
  EXPECT_GT(fs::file_size(folder_ / "flight.png"), 20'000U);
  EXPECT_TRUE(fs::exists(folder_ / "flight.gp")) << "kept to draw the picture again";
}

TEST_F(FlightFilesTest, ReportsWhyNoPictureIsDrawn) {
  const char* const before = std::getenv("PATH");
  const std::string path = before != nullptr ? before : "";
  setenv("PATH", folder_.c_str(), 1);
  const std::string sentence = draw_flight(folder_, {}, {});
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(sentence, "no picture was drawn: gnuplot is not installed (flight.gp draws it from flight.csv)");
}

TEST_F(FlightFilesTest, ReportsTheExitStatusOfGnuplot) {
  ASSERT_FALSE(find_program("gnuplot").empty()) << "install the packages of packages.txt";
  const std::string sentence = draw_flight(folder_, {}, {});  // there is no flight.csv
  EXPECT_EQ(sentence.find("no picture was drawn: gnuplot ended with exit status"), 0U) << sentence;
}

TEST_F(FlightFilesTest, ThrowsWhenTheFolderIsMissing) {
  FlightRecord record(10);
  EXPECT_THROW(write_flight_csv(folder_ / "gone" / "flight.csv", record, {}), std::runtime_error);
  EXPECT_THROW(write_report_json(folder_ / "gone" / "report.json", {}), std::runtime_error);
}

}  // namespace
}  // namespace swiftlet::ground
