#include "swiftlet/ground/mission/mission_check.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/ground/mission/mission_plot.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::ground::mission_check_test {

using control::Demand;
using control::WorstDemand;

const std::string kConfig = tests::in_source("config/");
const std::string kHead = "frame: ned\ntolerance_m: 0.1\nitems:\n";

class MissionCheckTest : public testing::Test {
 protected:
  io::MissionFile parse(const std::string& text) const {
    return io::parse_mission_file(text, "m.yaml", settings_.limits);
  }
  MissionCheck checked(const io::MissionFile& file) const {
    return check_mission(file, vehicle_, settings_, {{0.0, 0.0}, 3.3});
  }
  static const WorstDemand& worst(const ItemCheck& item, Demand demand) {
    return item.demands.at(static_cast<std::size_t>(demand));
  }

  plant::Vehicle vehicle_ = io::load_vehicle(kConfig + "vehicles/kaylion.yaml");
  control::ControlSettings settings_ = io::load_control_settings(kConfig + "control/motor_lag.yaml");
};

TEST_F(MissionCheckTest, AcceptsTheConfiguredMissions) {
  for (const char* name : {"square", "zigzag", "tour"}) {
    const io::MissionFile file =
        io::load_mission_file(kConfig + "missions/" + name + ".yaml", settings_.limits);
    const MissionCheck check = checked(file);
    EXPECT_TRUE(check.feasible()) << check_table(check, file, vehicle_.name);
    EXPECT_EQ(check.items.size(), file.mission.items.size());
  }
}

// The controller plans a move of 2 m at 0.5 m/s as a minimum-jerk path of 7.5 s with known peaks.
TEST_F(MissionCheckTest, FindsTheWorstDemandWithTimeAndPosition) {
  const io::MissionFile file = parse(kHead +
                                     "  - {kind: takeoff, height_m: 1, speed_m_s: 0.5, hold_s: 1.5}\n"
                                     "  - {kind: waypoint, position_m: [2, 0, -1], speed_m_s: 0.5}\n"
                                     "  - {kind: wait, duration_s: 2}\n"
                                     "  - {kind: land, speed_m_s: 0.4}\n");
  const MissionCheck check = checked(file);
  ASSERT_TRUE(check.feasible()) << check_table(check, file, vehicle_.name);
  ASSERT_EQ(check.items.size(), 4U);
  const ItemCheck& leg = check.items[1];
  EXPECT_EQ(leg.line, 5);
  EXPECT_NEAR(check.items[0].duration_s, 0.8 + 3.75 + 1.5, 0.01) << "spool-up, climb, hold";
  EXPECT_NEAR(leg.start_s, check.items[0].duration_s, 1e-6);
  EXPECT_NEAR(leg.duration_s, 7.5, 0.01);
  const WorstDemand& speed = worst(leg, Demand::kSpeed);
  EXPECT_NEAR(speed.value, 0.5, 1e-4);
  EXPECT_NEAR(speed.time_s, leg.start_s + 3.75, 0.02);
  EXPECT_NEAR(speed.position_ned.x(), 1.0, 0.01);
  EXPECT_NEAR(worst(leg, Demand::kAcceleration).value, 10.0 / std::sqrt(3.0) * 2.0 / (7.5 * 7.5), 1e-4);
  EXPECT_TRUE(check.items[2].demands.empty()) << "the vehicle does not move";
  EXPECT_NEAR(check.items[2].duration_s, 2.0, 0.01);
}

TEST_F(MissionCheckTest, ReportsWhereATooHeavyVehicleExceedsItsLimit) {
  const io::MissionFile file = io::load_mission_file(kConfig + "missions/square.yaml", settings_.limits);
  vehicle_.mass_kg *= 2.5;
  const MissionCheck check = checked(file);
  EXPECT_FALSE(check.feasible());
  const WorstDemand& rotor = worst(check.items[0], Demand::kRotorMost);
  EXPECT_TRUE(rotor.exceeded());
  EXPECT_NE(check.refusal().find("item "), std::string::npos) << check.refusal();
  const std::string table = check_table(check, file, vehicle_.name);
  EXPECT_NE(table.find("item 1 (takeoff, line 10): greatest thrust of a rotor is "), std::string::npos)
      << table;
  EXPECT_NE(table.find(vehicle_.name + " cannot fly the mission"), std::string::npos) << table;
  const auto json = nlohmann::json::parse(check_json(check, file, vehicle_.name, settings_.name, ""));
  EXPECT_EQ(json.at("feasible"), false);
  const auto& demand = json.at("items").at(0).at("demands").at(static_cast<std::size_t>(Demand::kRotorMost));
  EXPECT_EQ(demand.at("demand"), "greatest thrust of a rotor");
  EXPECT_EQ(demand.at("exceeded"), true);
  EXPECT_DOUBLE_EQ(demand.at("value").get<double>(), rotor.value);
}

// GIVEN a trajectory of two segments after a leg to its start, and a move after a wait THEN the time of each
// worst demand is mission time, which includes earlier legs, holds and waits
TEST_F(MissionCheckTest, GivesTheWorstDemandOfALaterLegInMissionTime) {
  io::MissionFile file = parse(kHead +
                               "  - {kind: takeoff, height_m: 1, speed_m_s: 0.5, hold_s: 1}\n"
                               "  - {kind: waypoint, position_m: [0.5, 0, -1], speed_m_s: 0.5}\n"
                               "  - {kind: wait, duration_s: 2}\n"
                               "  - {kind: waypoint, position_m: [0.5, 1, -1], speed_m_s: 0.4}\n"
                               "  - {kind: land, speed_m_s: 0.4}\n");
  file.mission.segments = {control::minimum_jerk({0.5, 0, -1}, 0.0, {1.0, 0, -1}, 0.0, 4.0),
                           control::minimum_jerk({1.0, 0, -1}, 0.0, {-0.5, 0, -1}, 0.0, 4.0)};
  control::MissionItem& item = file.mission.items[1];
  item.kind = control::MissionItemKind::kTrajectory;
  item.segment_count = 2;
  const MissionCheck check = checked(file);
  ASSERT_TRUE(check.feasible()) << check_table(check, file, vehicle_.name);
  ASSERT_EQ(check.items.size(), 5U);
  // The second segment is the faster one: 15/8 of 1.5 m in 4 s, in its middle.
  const ItemCheck& leg = check.items[1];
  const WorstDemand& speed = worst(leg, Demand::kSpeed);
  EXPECT_NEAR(speed.value, 15.0 / 8.0 * 1.5 / 4.0, 1e-3);
  EXPECT_NEAR(speed.time_s, leg.start_s + leg.duration_s - 2.0, 0.05);
  EXPECT_NEAR(speed.position_ned.x(), 0.25, 0.02);
  const ItemCheck& last = check.items[3];
  EXPECT_NEAR(worst(last, Demand::kSpeed).value, 0.4, 1e-3);
  EXPECT_NEAR(worst(last, Demand::kSpeed).time_s, last.start_s + 0.5 * last.duration_s, 0.05);
  EXPECT_NEAR(last.start_s, leg.start_s + leg.duration_s + 2.0, 0.02) << "the wait";
}

// A segment within the limits of speed and acceleration can still exceed the tilt limit.
TEST_F(MissionCheckTest, FindsATrajectoryThatTiltsTooFar) {
  io::MissionFile file = parse(kHead +
                               "  - {kind: takeoff, height_m: 2, speed_m_s: 0.5}\n"
                               "  - {kind: waypoint, position_m: [-0.5, 0, -2], speed_m_s: 0.5}\n"
                               "  - {kind: land, speed_m_s: 0.4}\n");
  settings_.limits.max_tilt_rad = 0.3;
  const control::PolynomialSegment lunge = control::minimum_jerk({-0.5, 0, -2}, 0.0, {0.5, 0, -2}, 0.0, 1.2);
  ASSERT_TRUE(control::check_segment("lunge", lunge, settings_.limits).accepted);
  file.mission.segments = {lunge};
  control::MissionItem& item = file.mission.items[1];
  item.kind = control::MissionItemKind::kTrajectory;
  item.segment_count = 1;
  const MissionCheck check = checked(file);
  EXPECT_FALSE(check.feasible());
  EXPECT_FALSE(worst(check.items[0], Demand::kTilt).exceeded());
  const WorstDemand& tilt = worst(check.items[1], Demand::kTilt);
  EXPECT_TRUE(tilt.exceeded());
  // The drag is small: atan of the peak acceleration over gravity.
  EXPECT_NEAR(tilt.value, std::atan(10.0 / std::sqrt(3.0) / (1.2 * 1.2) / 9.81), 0.02);
}

TEST_F(MissionCheckTest, RefusesWhatTheControlServiceRefuses) {
  const io::MissionFile file = parse("geofence: {min_m: [0.5, -1, -2], max_m: [2, 1, 0.2]}\n" + kHead +
                                     "  - {kind: takeoff, height_m: 1, speed_m_s: 0.5}\n"
                                     "  - {kind: waypoint, position_m: [1, 0, -1], speed_m_s: 0.5}\n"
                                     "  - {kind: land, speed_m_s: 0.4}\n");
  const MissionCheck outside = checked(file);
  EXPECT_FALSE(outside.feasible());
  EXPECT_EQ(outside.reason,
            "mission refused: the vehicle: x is 0.000 m, outside the fence of 0.500 to 2.000 m");
  EXPECT_EQ(outside.refusal(), "the control service would not complete it: " + outside.reason);
  const MissionCheck inside = check_mission(file, vehicle_, settings_, {{1.0, 0.0}, 3.3});
  EXPECT_TRUE(inside.feasible()) << inside.refusal();
}

TEST_F(MissionCheckTest, StartsAnAirborneMissionFromAHover) {
  const io::MissionFile file =
      parse("ends: hovering\n" + kHead + "  - {kind: waypoint, position_m: [1, 0, -1], speed_m_s: 0.5}\n");
  const MissionCheck check = checked(file);
  EXPECT_TRUE(check.feasible()) << check.reason;
  EXPECT_NEAR(check.duration_s, 15.0 / 8.0 / 0.5, 0.01);
}

// The legs of the dry run equal the segments of the mission bit for bit.
TEST_F(MissionCheckTest, DryRunFliesEverySegmentOfATrajectory) {
  const io::MissionFile file = io::load_mission_file(kConfig + "missions/tour.yaml", settings_.limits);
  const MissionDryRun run = dry_run(file.mission, settings_, {0.0, 0.0});
  ASSERT_TRUE(run.completed) << run.reason;
  for (std::size_t i = 0; i < file.mission.items.size(); ++i) {
    const control::MissionItem& item = file.mission.items[i];
    if (item.kind != control::MissionItemKind::kTrajectory) continue;
    std::size_t flown = 0;
    for (const DryRunLeg& leg : run.legs) {
      const control::PolynomialSegment& next =
          file.mission.segments[item.first_segment + std::min<std::size_t>(flown, item.segment_count - 1)];
      if (leg.item == i && leg.segment.x == next.x && leg.segment.y == next.y) ++flown;
    }
    EXPECT_EQ(flown, item.segment_count) << "item " << i + 1;
  }
}

TEST_F(MissionCheckTest, DrawsThePathAsPng) {
  const tests::TemporaryFolder folder;
  const io::MissionFile file = io::load_mission_file(kConfig + "missions/tour.yaml", settings_.limits);
  const std::filesystem::path png = folder.path() / "tour.png";
  ASSERT_EQ(draw_mission(png, file, dry_run(file.mission, settings_, {0.0, 0.0}), settings_.limits), "");
  std::ifstream picture(png, std::ios::binary);
  std::string magic(8, '\0');
  picture.read(magic.data(), 8);
  EXPECT_EQ(magic, "\x89PNG\r\n\x1a\n");
  EXPECT_GT(std::filesystem::file_size(png), 50'000U);
  EXPECT_NE(draw_mission(folder.path() / "none" / "tour.png", file,
                         dry_run(file.mission, settings_, {0.0, 0.0}), settings_.limits)
                .find("cannot be written"),
            std::string::npos);
}

}  // namespace swiftlet::ground::mission_check_test
