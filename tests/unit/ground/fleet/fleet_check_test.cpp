#include "swiftlet/ground/fleet/fleet_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/fleet/fleet_plot.hpp"
#include "swiftlet/io/config_error.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::ground::fleet_check_test {

using nlohmann::json;
using tests::TemporaryFolder;

const std::string kFleets = tests::in_source("config/fleets/");
const std::string kHead =
    "frame: ned\nvehicle: crazyflie2\nsafety: {radius_xy_m: 0.15, radius_z_m: 0.3}\nvehicles:\n";
const std::string kHop =
    "frame: ned\ntolerance_m: 0.1\nitems:\n  - {kind: takeoff, height_m: 1, speed_m_s: 0.5}\n";

class FleetCheckTest : public testing::Test {
 protected:
  // A mission that flies to a place at 1 m height, waits, and lands there.
  void mission(const std::string& name, const std::string& place, double wait_s = 0.0) {
    folder_.write(name, kHop + "  - {kind: waypoint, position_m: " + place + ", speed_m_s: 0.5, hold_s: " +
                            std::to_string(wait_s) + "}\n  - {kind: land, speed_m_s: 0.4}\n");
  }
  FleetCheck checked(const std::string& vehicles) {
    return check_fleet(load_fleet_file(folder_.write("f.yaml", kHead + vehicles)));
  }
  std::string refusal_of_file(const std::string& text) {
    try {
      check_fleet(load_fleet_file(folder_.write("f.yaml", text)));
    } catch (const io::ConfigError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
};

TEST_F(FleetCheckTest, AcceptsTheConfiguredFleet) {
  const FleetCheck check = check_fleet(load_fleet_file(kFleets + "swap6.yaml"));
  EXPECT_TRUE(check.feasible()) << check.refusal();
  EXPECT_EQ(check.vehicles.size(), 6U);
  EXPECT_EQ(check.pairs.size(), 15U);
  // Each lands on the place of the one opposite.
  for (const auto& [one, other] : {std::pair<std::size_t, std::size_t>{0, 5}, {1, 4}, {2, 3}}) {
    const FlightPath& path = check.vehicles[one].path;
    EXPECT_LT((path.at(path.duration_s()) - check.vehicles[other].path.at(0.0)).norm(), 1e-4);
  }
  EXPECT_NE(check_table(check).find("swap6 can be flown in "), std::string::npos);
}

TEST_F(FleetCheckTest, IsDrawnWithItsLeastClearance) {
  const FleetCheck check = check_fleet(load_fleet_file(kFleets + "swap6.yaml"));
  const plot::Figure figure = fleet_figure(check);
  ASSERT_EQ(figure.panels.size(), 6U);
  for (const std::size_t panel : {0, 1, 2, 4, 5}) EXPECT_EQ(figure.panels[panel].series.size(), 6U) << panel;
  EXPECT_EQ(figure.panels[4].series[2].label, "cf3");
  double least = 1e9;
  for (const plot::Point& point : figure.panels[3].series[0].points) least = std::min(least, point.y);
  EXPECT_NEAR(least, check.pairs.front().closest.clearance, 0.02);
  const plot::Point end = figure.panels[4].series[0].points.back();
  const Eigen::Vector3d lands = check.vehicles[0].path.at(1e3);
  EXPECT_NEAR(end.x, lands.y(), 1e-9) << "east";
  EXPECT_NEAR(end.y, lands.x(), 1e-9) << "north";
}

// Two trajectories that cross at different times, but end at one spot.
TEST_F(FleetCheckTest, RefusesTwoThatLandOnOneSpot) {
  mission("a.yaml", "[1, 1, -1]");
  mission("b.yaml", "[1, 1, -1]", 3.0);
  const FleetCheck check = checked(
      "  - {name: a, start_m: [0, 0], mission: a.yaml}\n  - {name: b, start_m: [2, 0], mission: b.yaml}\n");
  EXPECT_FALSE(check.feasible());
  const std::string refusal = check.refusal();
  EXPECT_EQ(refusal.rfind("a and b come too near: 0.0", 0), 0U) << refusal;
  EXPECT_NE(refusal.find("they must be 0.30 m apart across, or 0.60 m in height"), std::string::npos)
      << refusal;
  const json report = json::parse(check_json(check));
  EXPECT_EQ(report.at("feasible"), false);
  EXPECT_EQ(report.at("pairs")[0].at("a"), "a");
  EXPECT_LT(report.at("pairs")[0].at("distance_m"), 0.31);
  EXPECT_NE(check_table(check).find("f cannot be flown: a and b come too near"), std::string::npos);
}

TEST_F(FleetCheckTest, RefusesPathsThatCrossAtOneTimeAndNotAtDifferentTimes) {
  mission("north.yaml", "[2, 0, -1]");
  mission("east.yaml", "[1, 1, -1]");
  const std::string north = "  - {name: a, start_m: [0, 0], mission: north.yaml}\n";
  EXPECT_FALSE(checked(north + "  - {name: b, start_m: [1, -1], mission: east.yaml}\n").feasible());
  mission("late.yaml", "[1, -1, -1]", 12.0);
  const FleetCheck check = checked(north + "  - {name: b, start_m: [1, -1], mission: late.yaml}\n");
  EXPECT_TRUE(check.feasible()) << check.refusal();
}

TEST_F(FleetCheckTest, ShiftsAMissionToItsStartOnlyIfToldTo) {
  mission("hop.yaml", "[0.5, 0, -1]");
  const FleetCheck check = checked(
      "  - {name: a, start_m: [0, 1], mission: hop.yaml, origin: start}\n"
      "  - {name: b, start_m: [0, -1], mission: hop.yaml}\n");
  const auto end = [&](std::size_t i) { return check.vehicles[i].path.at(1e3); };
  EXPECT_LT((end(0) - Eigen::Vector3d(0.5, 1, 0)).norm(), 1e-6);
  EXPECT_LT((end(1) - Eigen::Vector3d(0.5, 0, 0)).norm(), 1e-6);
}

TEST_F(FleetCheckTest, RefusesWhatAVehicleCannotFly) {
  // 10 Hz: within the limits of the reference, but the rotors cannot follow.
  std::string samples = "t,x,y,z\n";
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.01 * i;
    samples += fmt::format("{:.2f},{:.6f},0,-1\n", t,
                           0.001 * std::sin(20.0 * M_PI * t) * std::pow(std::sin(0.5 * M_PI * t), 2));
  }
  folder_.write("shake.csv", samples);
  const FleetCheck check = checked("  - {name: a, start_m: [0, 0], mission: shake.csv}\n");
  ASSERT_FALSE(check.feasible()) << check_table(check);
  EXPECT_EQ(check.refusal().rfind("a cannot fly shake: ", 0), 0U) << check.refusal();
}

TEST_F(FleetCheckTest, NamesFileLineAndKeyOfBadFiles) {
  mission("hop.yaml", "[0.5, 0, -1]");
  folder_.write("flight.yaml", kHop + "  - {kind: waypoint, position_m: [1, 0, -1], speed_m_s: 0.5}\n");
  const std::string one = "  - {name: a, start_m: [0, 0], mission: hop.yaml}\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {kHead + one + one, "f.yaml:6: vehicles[1].name: is 'a', which another vehicle has"},
      {kHead + "  - {name: 1a, start_m: [0, 0], mission: hop.yaml}\n", "vehicles[0].name: must be 1 to 64"},
      {kHead + "  - {name: a, start_m: [0, 0, 1], mission: hop.yaml}\n", "vehicles[0].start_m: "},
      {kHead + "  - {name: a, start_m: [0, 0], mission: hup.yaml}\n",
       "f.yaml:5: vehicles[0].mission: names no file: "},
      {kHead + "  - {name: a, start_m: [0, 0], mission: hop.yaml, priority: 0}\n",
       "vehicles[0].priority: is 0"},
      {kHead + "  - {name: a, start: [0, 0], mission: hop.yaml}\n", "vehicles[0].start: "},
      {"frame: enu\nvehicles:\n" + one, "safety: "},
      {"frame: enu\nvehicle: crazyflie2\nvehicles:\n" + one + "safety: {radius_xy_m: 1, radius_z_m: 1}\n",
       "stands after vehicles"},
      {"frame: enu\nvehicle: crazyflie2\nsafety: {radius_xy_m: 0.05, radius_z_m: 1}\nvehicles:\n" + one,
       "safety.radius_xy_m: is 0.05 m, must be at least 0.08 m: a, a crazyflie2, is up to 0.16 m wide"},
      {kHead + "  - {name: a, start_m: [2.9, 0], mission: hop.yaml, origin: start}\n", "flown by a: "},
  };
  for (const auto& [text, part] : cases) {
    const std::string refusal = refusal_of_file(text);
    EXPECT_NE(refusal.find(part), std::string::npos) << "expected " << part << "\nis " << refusal;
  }
}

}  // namespace swiftlet::ground::fleet_check_test
