// Fleets from a file, flown over DDS.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
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
  const ProgramResult result = fly(fleet("kaylion"), {"--clock", "lockstep", "--mcap"});
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
  // The recording has the files of both.
  const ProgramResult recorded =
      run_program("swiftlet", {"report", record() / "flight.mcap", "--json"}, folder_.path());
  ASSERT_EQ(recorded.exit_code, 0) << recorded.errors;
  const json flights = json::parse(recorded.output).at("flights");
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string model = i == 0 ? "crazyflie2" : "kaylion";
    EXPECT_EQ(flights[i].at("report").at("vehicle"), model);
    EXPECT_EQ(flights[i].at("settings").at("vehicle.name"), model);
  }
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

// GIVEN a vehicle that its pilot pauses WHEN another one is to pass the same place after it THEN that waits, the pilot's is not
// resumed, and both go on when the pilot resumes it.
TEST_F(SwarmFlight, WaitsForOneThatThePilotHasPausedAndLeavesItPaused) {
  folder_.write(
      "first.yaml",
      "frame: ned\ntolerance_m: 0.1\nitems:\n  - {kind: takeoff, height_m: 0.6, speed_m_s: 0.5}\n"
      "  - {kind: waypoint, position_m: [1.5, 0, -0.6], speed_m_s: 0.3}\n  - {kind: land, speed_m_s: 0.4}\n");
  folder_.write(
      "second.yaml",
      "frame: ned\ntolerance_m: 0.1\nitems:\n"
      "  - {kind: takeoff, height_m: 0.6, speed_m_s: 0.5, hold_s: 8}\n"
      "  - {kind: waypoint, position_m: [0, 1.5, -0.6], speed_m_s: 0.3}\n  - {kind: land, speed_m_s: 0.4}\n");
  const std::string file = folder_.write(
      "cross.yaml",
      "frame: ned\nvehicle: crazyflie2\nsafety: {radius_xy_m: 0.2, radius_z_m: 0.3}\nvehicles:\n"
      "  - {name: a, start_m: [-1.5, 0], mission: first.yaml}\n  - {name: b, start_m: [0, -1.5], mission: "
      "second.yaml}\n");
  Program fly("swiftlet", {"fleet", "fly", file, "--record", record().string(), "--json"}, folder_.path());
  const auto said = [&](const std::string& text) { return fly.errors().find(text) != std::string::npos; };
  ASSERT_TRUE(eventually([&] { return said("a: ") && said("2/3 waypoint"); }, kStuck)) << fly.errors();
  const std::size_t at = fly.errors().find(" in domain ");
  ASSERT_NE(at, std::string::npos);
  const std::string domain = std::to_string(std::stoi(fly.errors().substr(at + 11)));
  const auto pilot = [&](const char* what) {
    return run_program(
        "swiftlet",
        {"mission", what, "--vehicle-name", "a", "--no-wait", "--localhost-only", "--domain", domain},
        folder_.path());
  };
  const ProgramResult paused = pilot("pause");
  ASSERT_EQ(paused.exit_code, 0) << paused.errors;
  EXPECT_TRUE(eventually([&] { return said("b: waits for a"); }, kStuck)) << fly.errors();
  const ProgramResult status = run_program(
      "swiftlet", {"status", "--json", "--vehicle-name", "a", "--localhost-only", "--domain", domain},
      folder_.path());
  EXPECT_EQ(json::parse(status.output).at("mission").at("state"), "paused")
      << "nobody but the pilot resumes it";
  EXPECT_FALSE(said("a: goes on")) << fly.errors();
  const ProgramResult resumed = pilot("resume");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.errors;
  ASSERT_EQ(fly.wait(kStuck), 0) << fly.errors();
  for (const json& vehicle : json::parse(fly.output()).at("vehicles"))
    EXPECT_EQ(vehicle.at("completed"), true);
  EXPECT_TRUE(said("b: goes on")) << fly.errors();
}

// Vehicles that run, beside each other along east at 1 m.
class RunningSwarm : public testing::Test {
 protected:
  static constexpr const char* kNames = "a,b,c";

  std::vector<std::string> on_this_domain(std::vector<std::string> words) const {
    words.insert(words.end(), {"--domain", std::to_string(lock_.domain()), "--localhost-only"});
    return words;
  }
  std::vector<std::string> of_process(std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--vehicle-name", kNames, "--clock", "lockstep"});
    return on_this_domain(more);
  }
  ProgramResult swiftlet(const std::vector<std::string>& words) const {
    return run_program("swiftlet", on_this_domain(words), folder_.path(), kStuck);
  }
  json status(const std::string& vehicle) const {
    const ProgramResult result = swiftlet({"status", "--json", "--watch", "0.2", "--vehicle-name", vehicle});
    return result.exit_code == 0 ? json::parse(result.output) : json::object();
  }
  std::string mode(const std::string& vehicle) const { return status(vehicle).value("mode", ""); }
  Eigen::Vector3d position(const std::string& vehicle) const {
    const json at = status(vehicle).at("position_ned_m");
    return {at[0].get<double>(), at[1].get<double>(), at[2].get<double>()};
  }
  void arm(const std::string& names) const {
    ProgramResult armed;
    ASSERT_TRUE(eventually(
        [&] {
          return (armed = swiftlet({"arm", "--vehicle-name", names})).exit_code == 0;
        },
        kStuck))
        << armed.errors;
  }
  void hover(const std::string& names) const {
    arm(names);
    const ProgramResult off = swiftlet({"takeoff", "1", "--vehicle-name", names});
    ASSERT_EQ(off.exit_code, 0) << off.errors;
  }

  comms::DomainLock lock_;
  TemporaryFolder folder_;
  Program plant_{"swiftlet-plant", of_process({"--speed", "1", "--spacing", "1"}), folder_.path()};
  Program mocap_{"swiftlet-mocap", of_process(), folder_.path()};
  Program control_{"swiftlet-control", of_process(), folder_.path()};
};

TEST_F(RunningSwarm, MovesAsOneAndLands) {
  hover(kNames);
  const Eigen::Vector3d a = position("a"), b = position("b"), c = position("c");
  const ProgramResult moved = swiftlet({"fleet", "goto", "0.5", "1.2", "-1.4"});
  ASSERT_EQ(moved.exit_code, 0) << moved.errors;
  const Eigen::Vector3d move = Eigen::Vector3d(0.5, 1.2, -1.4) - (a + b + c) / 3.0;
  EXPECT_LT((position("a") - a - move).norm(), 0.06);
  EXPECT_LT((position("b") - b - move).norm(), 0.06);
  EXPECT_LT((position("c") - c - move).norm(), 0.06);

  // A part of it, towards the rest.
  const ProgramResult refused = swiftlet({"fleet", "goto", "0.5", "1.3", "-1.4", "--vehicle-name", "a"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.errors.find("a would come too near to b: "), std::string::npos) << refused.errors;
  EXPECT_NE(refused.errors.find("nothing was sent"), std::string::npos) << refused.errors;
  // One refuses what lies outside its fence: the others hold.
  const ProgramResult outside = swiftlet({"fleet", "goto", "0.5", "2.5", "-1.4"});
  EXPECT_EQ(outside.exit_code, 1);
  EXPECT_NE(outside.errors.find("a: holds, because c did not accept it"), std::string::npos)
      << outside.errors;
  EXPECT_LT((position("a") - a - move).norm(), 0.3);

  const ProgramResult one = swiftlet({"fleet", "land", "--vehicle-name", "b"});
  ASSERT_EQ(one.exit_code, 0) << one.errors;
  EXPECT_EQ(mode("b"), "disarmed");
  EXPECT_EQ(mode("a"), "holding");
  const ProgramResult all = swiftlet({"fleet", "land"});
  ASSERT_EQ(all.exit_code, 0) << all.errors;
  for (const char* const name : {"a", "c"}) EXPECT_EQ(mode(name), "disarmed") << name;
  const ProgramResult again = swiftlet({"fleet", "land"});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.errors.find("no vehicle flies: nothing was sent"), std::string::npos) << again.errors;
}

TEST_F(RunningSwarm, LandsNobodyOnAnother) {
  hover("a,b");
  ASSERT_EQ(swiftlet({"goto", "0", "2", "-1.9", "--vehicle-name", "a"}).exit_code,
            0);  // above c, which stands
  const ProgramResult landed = swiftlet({"fleet", "land"});
  EXPECT_EQ(landed.exit_code, 1);
  EXPECT_NE(landed.errors.find("a: was not landed: it would come down on c"), std::string::npos)
      << landed.errors;
  EXPECT_EQ(mode("a"), "holding");
  EXPECT_EQ(mode("b"), "disarmed");
}

TEST_F(RunningSwarm, IsStoppedAtOnce) {
  arm("a,b");
  EXPECT_EQ(swiftlet({"fleet", "stop"}).exit_code, 2) << "without --yes";
  EXPECT_EQ(mode("a"), "armed");
  const ProgramResult one = swiftlet({"fleet", "stop", "--yes", "--vehicle-name", "b"});
  EXPECT_EQ(one.exit_code, 0) << one.errors;
  EXPECT_EQ(mode("a"), "armed");
  EXPECT_EQ(mode("b"), "stopped");
  const ProgramResult all = swiftlet({"fleet", "stop", "--yes"});
  EXPECT_EQ(all.exit_code, 0) << all.errors;
  for (const char* const name : {"a", "b", "c"}) EXPECT_EQ(mode(name), "stopped") << name;
}

}  // namespace
}  // namespace swiftlet::tests
