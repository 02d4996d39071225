// Fleets from a file, flown over DDS.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
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

struct Climb {
  double z_m, vz_m_s;  // NED
};

// The vertical reference of a record by the stamp of its row, as it stands in the file.
std::map<std::string, Climb> climb_of(const fs::path& flight_csv) {
  std::ifstream file(flight_csv);
  const auto fields_of = [](const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
    return fields;
  };
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = fields_of(line);
  const auto column = [&names](const char* name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  const std::size_t z = column("ref_z_ned [m]"), vz = column("ref_vz_ned [m/s]");
  std::map<std::string, Climb> climb;
  while (std::getline(file, line)) {
    const std::vector<std::string> fields = fields_of(line);
    if (fields.size() > vz && !fields[z].empty())
      climb[fields[0]] = {std::stod(fields[z]), std::stod(fields[vz])};
  }
  return climb;
}

// The greatest difference in time, s, between two references of the same climb, and how many rows show it.
struct Difference {
  double greatest_s = 0.0;
  int rows = 0;
};

Difference difference_of(const fs::path& one, const fs::path& other) {
  const std::map<std::string, Climb> reference = climb_of(other);
  Difference difference;
  for (const auto& [stamp, climb] : climb_of(one)) {
    const auto there = reference.find(stamp);
    if (climb.vz_m_s > -0.3 || there == reference.end()) continue;
    ++difference.rows;
    difference.greatest_s =
        std::max(difference.greatest_s, std::abs((climb.z_m - there->second.z_m) / climb.vz_m_s));
  }
  return difference;
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
  fs::path record() const { return folder_.path() / "record"; }

  TemporaryFolder folder_;
};

TEST_F(SwarmFlight, FliesVehiclesOfTwoFilesFromTheirPlaces) {
  const ProgramResult result = fly(fleet("kaylion"), {"--clock", "lockstep"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const json report = json::parse(result.output);
  EXPECT_EQ(report.at("completed"), true);
  EXPECT_EQ(report.at("vehicles")[0].at("vehicle"), "crazyflie2");
  EXPECT_EQ(report.at("vehicles")[1].at("vehicle"), "kaylion");
  EXPECT_EQ(report.at("vehicles")[0].at("start_m"), json({0.5, -1.0}));
  EXPECT_EQ(report.at("vehicles")[1].at("start_m"), json({0.5, 1.0}));
  EXPECT_TRUE(fs::exists(record() / "swiftlet-plant-kaylion.log"));
  const Difference difference = difference_of(record() / "a" / "flight.csv", record() / "b" / "flight.csv");
  EXPECT_GT(difference.rows, 50);
  EXPECT_LT(difference.greatest_s,
            5e-4);  // they climb from their estimates of the ground, which differ by 0.03 mm
}

// One plant serves both vehicles, so that their stamps are of one clock.
TEST_F(SwarmFlight, StartsWithinTwoMillisecondsInRealTime) {
  const ProgramResult result = fly(fleet("crazyflie2"));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const Difference difference = difference_of(record() / "a" / "flight.csv", record() / "b" / "flight.csv");
  EXPECT_GT(difference.rows, 50);
  EXPECT_LT(difference.greatest_s, 2e-3);
  RecordProperty("difference_us", static_cast<int>(1e6 * difference.greatest_s));
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
