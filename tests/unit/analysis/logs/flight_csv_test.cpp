#include "swiftlet/analysis/logs/flight_csv.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/analysis/flown_flight.hpp"

namespace swiftlet::analysis::flight_csv_test {

namespace fs = std::filesystem;

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

class FlightCsv : public testing::Test {
 protected:
  // Writes the flight. Returns the cell of a row, from 1.
  std::string cell(std::size_t row, const std::string& column) const {
    const auto at = std::find(rows_[0].begin(), rows_[0].end(), column) - rows_[0].begin();
    return rows_.at(row).at(static_cast<std::size_t>(at));
  }
  void write(const record::Flight& flight) {
    write_flight_csv(temporary_.path() / "flight.csv", flight);
    rows_ = table(temporary_.path() / "flight.csv");
    for (const auto& row : rows_) ASSERT_EQ(row.size(), rows_.front().size());
  }
  tests::TemporaryFolder temporary_;
  std::vector<std::vector<std::string>> rows_;
};

TEST_F(FlightCsv, HasARowForEachReference) {
  record::Flight flight = flown(30, 10);
  for (int i = 0; i < 30; ++i) {
    plant::ActuatorCommand command;
    command.stamp_ns = 1'000'000'000 + i * 2'000'000LL;
    command.rotor_count = 4;
    command.throttle = {0.01 * i, 0.2, 0.3, 0.4};
    flight.commands.push_back(command);
  }
  write(flight);
  ASSERT_EQ(rows_.size(), 4U) << "header, references at 0, 10 and 20 ms";
  EXPECT_EQ(cell(1, "t [s]"), "0.000000") << "t = 0 is the start of the flight";
  EXPECT_EQ(cell(3, "x_ned [m]"), "0.51");
  EXPECT_EQ(cell(3, "ref_x_ned [m]"), "0.511");
  EXPECT_EQ(cell(3, "ref_az_ned [m/s^2]"), "0.25");
  EXPECT_EQ(cell(3, "ref_qx_ned_from_frd [1]"), "0.6");
  EXPECT_EQ(cell(3, "command_thrust [N]"), "0.4");
  EXPECT_EQ(cell(3, "command_moment_z_frd [N*m]"), "0.003");
  EXPECT_EQ(cell(3, "mode"), "mission");
  EXPECT_EQ(cell(3, "est_x_ned [m]"), "") << "no estimate with this stamp";
  EXPECT_EQ(cell(3, "supply_voltage [V]"), "4.1");
  EXPECT_EQ(cell(3, "rotor_speed4 [rad/s]"), "1603");
  EXPECT_EQ(cell(3, "throttle1 [1]"), "0.1") << "of the sample of the same stamp";
  EXPECT_EQ(cell(3, "throttle4 [1]"), "0.4");
}

// GIVEN truth with stamps of its own, as beside PX4 THEN it is interpolated at the stamps of the references.
TEST_F(FlightCsv, HasTheReferencesOfATruthWithOtherStamps) {
  record::Flight flight = flown(30, 30);
  for (record::TruthRow& row : flight.truth) {
    row.stamp_ns += 1'000'000;
    row.velocity_ned = {0.5, 0.0, 0.0};
    row.q_ned_from_frd = {1.0, 0.0, 0.0, 0.0};
  }
  write(flight);
  ASSERT_EQ(rows_.size(), 6U) << "header, references from 10 to 50 ms; before that at 0 there is no truth";
  EXPECT_EQ(cell(2, "t [s]"), "0.020000");
  EXPECT_EQ(cell(2, "ref_x_ned [m]"), "0.511");
  EXPECT_NEAR(std::stod(cell(2, "x_ned [m]")), 0.5095, 1e-9);
}

TEST_F(FlightCsv, ThrowsWhenTheFolderIsMissing) {
  EXPECT_THROW(write_flight_csv(temporary_.path() / "gone" / "flight.csv", {}), std::runtime_error);
}

}  // namespace swiftlet::analysis::flight_csv_test
