// Fleets from a file, flown over DDS.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/eventually.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// A table of `swiftlet log csv`, by column.
using Table = std::map<std::string, std::vector<double>>;

Table read_table(const fs::path& csv) {
  std::ifstream file(csv);
  const auto fields_of = [](const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
    return fields;
  };
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = fields_of(line);
  Table table;
  while (std::getline(file, line)) {
    const std::vector<std::string> fields = fields_of(line);
    for (std::size_t i = 0; i < names.size(); ++i)
      table[names[i]].push_back(std::strtod(fields.at(i).c_str(), nullptr));
  }
  return table;
}

// The wall clock minus the vehicle's, ns: of the quickest of the IMU samples that were sent within these times, by the wall
// clock.
double clock_difference(const Table& imu, double from_ns, double to_ns) {
  double least_ns = std::numeric_limits<double>::infinity();
  const std::vector<double>&sent = imu.at("publish_time_ns"), &stamps = imu.at("stamp_ns");
  for (std::size_t i = 0; i < sent.size(); ++i) {
    if (sent[i] >= from_ns && sent[i] < to_ns) least_ns = std::min(least_ns, sent[i] - stamps[i]);
  }
  return least_ns;
}

// How a vehicle was started.
struct Start {
  double stamp_ns = 0.0;    // on its clock
  double wall_ns = 0.0;     // by the wall clock of this host
  bool is_certain = false;  // its clock ran at the rate of the host's meanwhile
};

Start start_of(const Table& command, const Table& imu) {
  Start start;
  start.stamp_ns = command.at("start_ns").back();
  const double sent_ns = command.at("publish_time_ns").back();
  const double earlier_ns = clock_difference(imu, sent_ns - 0.3e9, sent_ns - 0.15e9);
  const double later_ns = clock_difference(imu, sent_ns - 0.15e9, sent_ns);
  start.wall_ns = start.stamp_ns + later_ns;
  start.is_certain = std::abs(later_ns - earlier_ns) < 0.3e6;
  return start;
}

// The vertical reference, m down, at a time after the start.
double z_after(const Table& reference, double start_ns, double after_ns) {
  const std::vector<double>&stamps = reference.at("stamp_ns"), &z = reference.at("position_ned[2]");
  const auto next = std::lower_bound(stamps.begin(), stamps.end(), start_ns + after_ns);
  if (next == stamps.begin() || next == stamps.end()) return std::numeric_limits<double>::quiet_NaN();
  const auto i = static_cast<std::size_t>(next - stamps.begin());
  const double part = (start_ns + after_ns - stamps[i - 1]) / (stamps[i] - stamps[i - 1]);
  return z[i - 1] + part * (z[i] - z[i - 1]);
}

class SwarmFlight : public testing::Test {
 protected:
  SwarmFlight() {
    folder_.write("hop.yaml",
                  "frame: ned\ntolerance_m: 0.1\nitems:\n  - {kind: takeoff, height_m: 0.6, speed_m_s: 0.5}\n"
                  "  - {kind: land, speed_m_s: 0.4}\n");
  }
  std::string fleet(const std::string& other_vehicle) const {
    return folder_.write(
        "f.yaml",
        "frame: ned\nvehicle: crazyflie2\nsafety: {radius_xy_m: 0.4, radius_z_m: 0.6}\nvehicles:\n"
        "  - {name: a, start_m: [0.5, -1], mission: hop.yaml}\n"
        "  - {name: b, start_m: [0.5, 1], mission: hop.yaml, vehicle: " +
            other_vehicle + "}\n");
  }
  ProgramResult fly(const std::string& file, std::vector<std::string> more = {}) const {
    std::vector<std::string> words = {"fleet", "fly", file, "--record", record().string(), "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program("swiftlet", words, folder_.path(), kStuck);
  }
  // A topic of the last flight, which was flown with --mcap.
  Table recorded(const std::string& topic) const {
    const fs::path csv = folder_.path() / "topic.csv";
    const ProgramResult written = run_program(
        "swiftlet",
        {"log", "csv", (record() / "flight.mcap").string(), topic, "--output", csv.string(), "--replace"},
        folder_.path(), kStuck);
    EXPECT_EQ(written.exit_code, 0) << written.errors;
    return read_table(csv);
  }
  // They climb alike by their own clocks, from their estimates of the ground, which differ by less than 0.3 mm.
  void expect_same_climb(const Start& a, const Start& b) const {
    const Table of_a = recorded("/a/reference"), of_b = recorded("/b/reference");
    double highest_m = 0.0;
    for (double after_ns = 1e9; after_ns < 3e9; after_ns += 1e7) {
      const double z_a = z_after(of_a, a.stamp_ns, after_ns), z_b = z_after(of_b, b.stamp_ns, after_ns);
      EXPECT_NEAR(z_a, z_b, 3e-4) << 1e-9 * after_ns << " s after the start";
      highest_m = std::max(highest_m, -z_a);
    }
    EXPECT_GT(highest_m, 0.5);
  }
  fs::path record() const { return folder_.path() / "record"; }

  TemporaryFolder folder_;
};

TEST_F(SwarmFlight, FliesVehiclesOfTwoFilesFromTheirPlaces) {
  const ProgramResult result = fly(fleet("kaylion"), {"--clock", "lockstep", "--mcap"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const json report = json::parse(result.output);
  EXPECT_EQ(report.at("completed"), true);
  EXPECT_EQ(report.at("vehicles")[0].at("vehicle"), "crazyflie2");
  EXPECT_EQ(report.at("vehicles")[1].at("vehicle"), "kaylion");
  EXPECT_EQ(report.at("vehicles")[0].at("start_m"), json({0.5, -1.0}));
  EXPECT_EQ(report.at("vehicles")[1].at("start_m"), json({0.5, 1.0}));
  EXPECT_TRUE(fs::exists(record() / "swiftlet-plant-kaylion.log"));
  const Start a = start_of(recorded("/a/command"), recorded("/a/imu"));
  const Start b = start_of(recorded("/b/command"), recorded("/b/imu"));
  EXPECT_EQ(a.stamp_ns, b.stamp_ns);
  expect_same_climb(a, b);
}

// A flight is repeated if a vehicle's clock fell behind just before its start, as on a busy computer.
TEST_F(SwarmFlight, StartsWithinTwoMillisecondsInRealTime) {
  Start a, b;
  for (int attempt = 0; attempt < 5 && !(a.is_certain && b.is_certain); ++attempt) {
    const ProgramResult result = fly(fleet("crazyflie2"), {"--mcap", "--replace"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    a = start_of(recorded("/a/command"), recorded("/a/imu"));
    b = start_of(recorded("/b/command"), recorded("/b/imu"));
  }
  EXPECT_TRUE(a.is_certain && b.is_certain);
  EXPECT_NEAR(a.wall_ns, b.wall_ns, 2e6);
  RecordProperty("difference_us", static_cast<int>(1e-3 * std::abs(a.wall_ns - b.wall_ns)));
  expect_same_climb(a, b);
}

TEST_F(SwarmFlight, SixVehiclesChangePlaces) {
  const ProgramResult result = fly("swap6", {"--clock", "lockstep"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const json report = json::parse(result.output);
  ASSERT_EQ(report.at("vehicles").size(), 6U);
  for (const json& vehicle : report.at("vehicles")) EXPECT_EQ(vehicle.at("completed"), true) << vehicle;
}

TEST_F(SwarmFlight, RefusesTwoThatLandOnOneSpot) {
  folder_.write(
      "meet.yaml",
      "frame: ned\ntolerance_m: 0.1\nitems:\n  - {kind: takeoff, height_m: 1, speed_m_s: 0.5}\n"
      "  - {kind: waypoint, position_m: [1, 1, -1], speed_m_s: 0.5}\n  - {kind: land, speed_m_s: 0.4}\n");
  const std::string file = folder_.write(
      "crossing.yaml",
      "frame: ned\nvehicle: crazyflie2\nsafety: {radius_xy_m: 0.15, radius_z_m: 0.3}\nvehicles:\n"
      "  - {name: a, start_m: [0, 0], mission: meet.yaml}\n  - {name: b, start_m: [2.5, 0], mission: "
      "meet.yaml}\n");
  const ProgramResult result = fly(file);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("a and b come too near: 0.000 m apart at "), std::string::npos)
      << result.errors;
  EXPECT_FALSE(fs::exists(record()));
}

}  // namespace
}  // namespace swiftlet::tests
