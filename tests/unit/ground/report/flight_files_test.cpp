#include "swiftlet/ground/report/flight_files.hpp"

#include <algorithm>
#include <fstream>
#include <memory>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/ground/command_line/child_process.hpp"
#include "tests/support/program_path.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::ground::flight_files_test {

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

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
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
    reference.acceleration_ned = {0.0, 0.0, 0.25};
    reference.q_ned_from_frd = {0.8, 0.6, 0.0, 0.0};
    reference.thrust_n = 0.4;
    reference.moment_frd = {0.001, 0.002, 0.003};
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
  EXPECT_EQ(rows[1][column("t [s]")], "-0.010000") << "t = 0 is the window's start";
  EXPECT_EQ(rows[3][column("x_ned [m]")], "0.51");
  EXPECT_EQ(rows[3][column("ref_x_ned [m]")], "0.511");
  EXPECT_EQ(rows[3][column("ref_az_ned [m/s^2]")], "0.25");
  EXPECT_EQ(rows[3][column("ref_qx_ned_from_frd [1]")], "0.6");
  EXPECT_EQ(rows[3][column("command_thrust [N]")], "0.4");
  EXPECT_EQ(rows[3][column("command_moment_z_frd [N*m]")], "0.003");
  EXPECT_EQ(rows[3][column("mode")], "mission");
  EXPECT_EQ(rows[3][column("est_x_ned [m]")], "") << "no estimate with this stamp";
  EXPECT_EQ(rows[3][column("supply_voltage [V]")], "4.1");
  EXPECT_EQ(rows[3][column("rotor_speed4 [rad/s]")], "1603");
  EXPECT_EQ(header.back(), "rotor_speed4 [rad/s]") << "no commands were recorded";
  EXPECT_EQ(rows[4][column("t [s]")], "0.026000");
  EXPECT_EQ(rows[4][column("mode")], "") << "no reference with this stamp";
  EXPECT_EQ(rows[4][column("ref_x_ned [m]")], "") << "no reference with this stamp";
  EXPECT_EQ(rows[5][column("t [s]")], "0.042000");
}

// GIVEN truth with stamps of its own, as beside PX4, but for one that is equal by accident THEN it is interpolated at the
// stamps of the references.
TEST_F(FlightFilesTest, CsvHasTheReferencesOfATruthWithOtherStamps) {
  FlightRecord of_reference(100), record(100);
  fly(of_reference, 30, 30);
  for (const TruthRow& row : of_reference.truth) {
    TruthRow later = row;
    const bool by_accident = row.stamp_ns == 1'030'000'000;
    later.stamp_ns += by_accident ? 0 : 1'000'000;
    later.velocity_ned = {0.5, 0.0, 0.0};
    later.q_ned_from_frd = {1.0, 0.0, 0.0, 0.0};
    record.truth.append(later);
  }
  for (const ReferenceRow& row : of_reference.reference) record.reference.append(row);
  write_flight_csv(folder_ / "flight.csv", record, {1'010'000'000, 1'100'000'000});
  const auto rows = table(folder_ / "flight.csv");
  ASSERT_EQ(rows.size(), 6U) << "header, references from 10 to 50 ms; before that at 0 there is no truth";
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin());
  };
  EXPECT_EQ(rows[2][column("t [s]")], "0.010000");
  EXPECT_EQ(rows[2][column("ref_x_ned [m]")], "0.511");
  EXPECT_NEAR(std::stod(rows[2][column("x_ned [m]")]), 0.5095, 1e-9);
}

TEST_F(FlightFilesTest, CsvHasTheCommandsOfARecordWithSensors) {
  FlightRecord record(100);
  record.sensors = std::make_unique<SensorRecord>(100);
  for (int i = 0; i < 30; ++i) {
    plant::ActuatorCommand command;
    command.stamp_ns = 1'000'000'000 + i * 2'000'000LL;
    command.rotor_count = 4;
    command.throttle = {0.01 * i, 0.2, 0.3, 0.4};
    record.sensors->commands.append(command);
  }
  write_flight_csv(folder_ / "flight.csv", fly(record, 30, 10), {1'010'000'000, 1'100'000'000});
  const auto rows = table(folder_ / "flight.csv");
  const std::size_t first = rows.front().size() - 4;
  EXPECT_EQ(rows.front()[first], "throttle1 [1]");
  EXPECT_EQ(rows[3][first], "0.1") << "of the sample of the same stamp";
  EXPECT_EQ(rows[3][first + 3], "0.4");
}

TEST_F(FlightFilesTest, DrawsAPicture) {
  ASSERT_FALSE(find_program("gnuplot").empty()) << "install the packages of packages.txt";
  FlightRecord record(2000);
  const Window window = {1'000'000'000, 3'000'000'000};
  FlightReport report;
  report.mission = "it's_a 'square'";  // must be escaped for gnuplot
  report.duration_s = 2.0;
  EXPECT_EQ(draw_flight(folder_, fly(record, 1000, 1000), report, window), "");
  std::ifstream picture(folder_ / "flight.png", std::ios::binary);
  std::string magic(8, '\0');
  picture.read(magic.data(), 8);
  EXPECT_EQ(magic, "\x89PNG\r\n\x1a\n");
  EXPECT_GT(fs::file_size(folder_ / "flight.png"), 20'000U);
  EXPECT_TRUE(fs::exists(folder_ / "flight.gp")) << "kept to draw the picture again";
}

// The script contains the data that it draws.
TEST_F(FlightFilesTest, DrawsPositionsPathAndErrors) {
  FlightRecord record(100);
  FlightReport report;
  report.mission = "square";
  report.vehicle = "kaylion";
  report.control = "motor_lag";
  report.errors.rms_3d_m = 0.001;
  report.errors.peak_3d_m = 0.0047;
  draw_flight(folder_, fly(record, 30, 10), report, {1'010'000'000, 1'100'000'000});
  const std::string script = text_of(folder_ / "flight.gp");
  for (const char* const part :
       {"'square - kaylion, motor_lag: 3-D error RMS 1.0 mm, peak 4.7 mm over 0 s - NOT completed'",
        "'north x (m)'", "'east y (m)'", "'down z (m)'", "'error, flown - reference (mm)'", "'time (s)'",
        "'plan view'", "'height -z (m)'", "title 'flown'", "title 'reference'", "title '3-D'",
        "\n0.01 0.51 0\n",               // north over time, of the truth
        "\n0.01 0.511 0\n",              // and of the reference
        "\n0.042 0.526 0\n",             // also without a reference
        "\n0.25 0.51 1\n",               // east, north, height
        "EOD\n0 -1 0\n0.01 -1 0\nEOD"})  // north errors, mm, in the window alone
    EXPECT_NE(script.find(part), std::string::npos) << part << "\n" << script;
}

TEST_F(FlightFilesTest, ReportsWhyNoPictureIsDrawn) {
  const tests::ProgramPath empty(folder_);
  EXPECT_EQ(draw_flight(folder_, FlightRecord(1), {}, {}),
            "no picture was drawn: gnuplot is not installed (flight.gp draws it)");
}

TEST_F(FlightFilesTest, ThrowsWhenTheFolderIsMissing) {
  FlightRecord record(10);
  EXPECT_THROW(write_flight_csv(folder_ / "gone" / "flight.csv", record, {}), std::runtime_error);
  EXPECT_THROW(write_report_json(folder_ / "gone" / "report.json", {}), std::runtime_error);
}

}  // namespace swiftlet::ground::flight_files_test
