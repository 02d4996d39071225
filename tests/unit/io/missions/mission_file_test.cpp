#include "swiftlet/io/missions/mission_file.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/planning/waypoint_path.hpp"
#include "swiftlet/io/config_error.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/fault.hpp"

namespace swiftlet::io::mission_file_test {

using control::MissionItemKind;

const std::string kHead = "frame: ned\ntolerance_m: 0.1\nitems:\n";
const std::string kHovers = "ends: hovering\n" + kHead;
const std::string kTakeoff = "  - {kind: takeoff, height_m: 1.0, speed_m_s: 0.5, hold_s: 2}\n";
const std::string kWaypoint = "  - {kind: waypoint, position_m: [2, -1, -1.5], speed_m_s: 0.5}\n";
const std::string kLand = "  - {kind: land, speed_m_s: 0.3}\n";

MissionFile parse(const std::string& text) { return parse_mission_file(text, "m.yaml", control::Limits{}); }

std::string refusal(const std::string& text) {
  try {
    parse(text);
  } catch (const io::ConfigError& error) {
    return error.what();
  }
  return "it was accepted";
}

TEST(MissionFile, ReadsEveryItem) {
  const MissionFile file =
      parse("name: tour\ndescription: Out and down\n" + kHead + kTakeoff +
            "  - {kind: waypoint, position_m: [2, -1, -1.5], yaw_rad: 1.5, speed_m_s: 0.5, "
            "hold_s: 3}\n" +
            kWaypoint + kLand);
  EXPECT_EQ(file.name, "tour");
  EXPECT_EQ(file.description, "Out and down");
  EXPECT_DOUBLE_EQ(file.tolerance_m, 0.1);
  EXPECT_TRUE(file.takes_off());
  EXPECT_TRUE(file.lands());
  const auto& items = file.mission.items;
  ASSERT_EQ(items.size(), 4U);
  EXPECT_EQ(items[0].kind, MissionItemKind::kTakeoff);
  EXPECT_DOUBLE_EQ(items[0].position_ned.z(), -1.0);
  EXPECT_DOUBLE_EQ(items[0].hold_s, 2.0);
  EXPECT_EQ(items[1].kind, MissionItemKind::kWaypoint);
  EXPECT_TRUE(items[1].position_ned.isApprox(Eigen::Vector3d(2, -1, -1.5)));
  EXPECT_FALSE(items[1].yaw_free);
  EXPECT_DOUBLE_EQ(items[1].yaw_rad, 1.5);
  EXPECT_DOUBLE_EQ(items[1].speed, 0.5);
  EXPECT_DOUBLE_EQ(items[1].hold_s, 3.0);
  EXPECT_TRUE(items[2].yaw_free);
  EXPECT_DOUBLE_EQ(items[2].hold_s, 0.0);
  EXPECT_EQ(items[3].kind, MissionItemKind::kLand);
  EXPECT_DOUBLE_EQ(items[3].speed, 0.3);
}

TEST(MissionFile, UsesTheFileNameWithoutANameKey) { EXPECT_EQ(parse(kHovers + kTakeoff).name, "m"); }

TEST(MissionFile, ConvertsEnuToNed) {
  const MissionFile file = parse(
      "frame: enu\ntolerance_m: 0.1\nends: hovering\nitems:\n"
      "  - {kind: takeoff, height_m: 1.0, speed_m_s: 0.5}\n"
      "  - {kind: waypoint, position_m: [1, 2, 1.5], yaw_rad: 0, speed_m_s: 0.5}\n"
      "  - {kind: waypoint, position_m: [1, 2, 1.5], yaw_rad: -3, speed_m_s: 0.5}\n");
  const auto& items = file.mission.items;
  EXPECT_DOUBLE_EQ(items[0].position_ned.z(), -1.0);
  EXPECT_TRUE(items[1].position_ned.isApprox(Eigen::Vector3d(2, 1, -1.5)));
  EXPECT_NEAR(items[1].yaw_rad, M_PI / 2, 1e-12) << "east";
  EXPECT_NEAR(items[2].yaw_rad, M_PI / 2 + 3.0 - 2 * M_PI, 1e-12);
}

TEST(MissionFile, SetItemGivesDefaultsForLaterItems) {
  const MissionFile file =
      parse(kHovers + "  - {kind: set, speed_m_s: 0.7, hold_s: 1}\n" +
            "  - {kind: takeoff, height_m: 1.0}\n" + "  - {kind: waypoint, position_m: [1, 0, -1]}\n" +
            "  - {kind: set, yaw_rad: 0.5, acceptance_radius_m: 0.05}\n" +
            "  - {kind: waypoint, position_m: [0, 0, -1], speed_m_s: 0.3, hold_s: 0}\n" +
            "  - {kind: waypoint, position_m: [1, 0, -1], yaw_rad: free, acceptance_radius_m: 0}\n");
  const auto& items = file.mission.items;
  ASSERT_EQ(items.size(), 4U);
  EXPECT_DOUBLE_EQ(items[0].speed, 0.7);
  EXPECT_DOUBLE_EQ(items[0].hold_s, 1.0);
  EXPECT_TRUE(items[1].yaw_free);
  EXPECT_DOUBLE_EQ(items[1].acceptance_radius_m, 0.0);
  EXPECT_DOUBLE_EQ(items[2].speed, 0.3);
  EXPECT_DOUBLE_EQ(items[2].hold_s, 0.0);
  EXPECT_DOUBLE_EQ(items[2].yaw_rad, 0.5);
  EXPECT_FALSE(items[2].yaw_free);
  EXPECT_DOUBLE_EQ(items[2].acceptance_radius_m, 0.05);
  EXPECT_DOUBLE_EQ(items[3].speed, 0.7);
  EXPECT_TRUE(items[3].yaw_free);
  EXPECT_DOUBLE_EQ(items[3].acceptance_radius_m, 0.0);
  EXPECT_EQ(file.lines, (std::vector<int>{6, 7, 9, 10}));
}

TEST(MissionFile, PlansAPathThroughItsPointsWithinLimits) {
  const MissionFile file = parse("limits: {acceleration_m_s2: 1, jerk_m_s3: 5}\n" + kHead + kTakeoff +
                                 "  - {kind: path, speed_m_s: 0.8, points: [[0, 0, -1], {position_m: [1, 1, "
                                 "-1.5], yaw_rad: 3}, [2, 0, -1],"
                                 " {position_m: [1, -1, -1], yaw_rad: -3}]}\n" +
                                 kLand);
  const control::MissionItem& item = file.mission.items[1];
  EXPECT_EQ(item.kind, MissionItemKind::kTrajectory);
  EXPECT_FALSE(item.yaw_free);
  ASSERT_EQ(item.segment_count, 3U);
  double duration_s = 0.0;
  for (const control::PolynomialSegment& segment : file.mission.segments) {
    const control::LimitUse use =
        control::limit_use(segment, {0.8, 1.0, 5.0, control::Limits{}.max_yaw_rate});
    EXPECT_LE(std::max({use.speed, use.acceleration, use.jerk, use.yaw_rate}), 1.0 + 1e-5);
    duration_s += segment.duration_s;
  }
  const auto end_of = [&](std::size_t i) {
    const control::PolynomialSegment& segment = file.mission.segments[i];
    return control::evaluate(segment, segment.duration_s);
  };
  EXPECT_TRUE(end_of(0).position_ned.isApprox(Eigen::Vector3d(1, 1, -1.5), 1e-6));
  EXPECT_GT(end_of(0).velocity_ned.norm(), 0.1) << "it does not stop";
  EXPECT_NEAR(file.mission.segments[0].yaw[0], 3.0, 1e-9) << "yaw of the first point that has one";
  EXPECT_NEAR(end_of(1).yaw_rad, 3.0, 1e-6) << "yaw of the previous point";
  EXPECT_NEAR(end_of(2).yaw_rad, 2 * M_PI - 3.0, 1e-6) << "the shorter turn";
  EXPECT_GT(planned_duration_s(file.mission, control::Limits{}), duration_s);
}

TEST(MissionFile, PathStaysInACorridorOrOnStraightLegs) {
  const std::string corner = "points: [[0, 0, -1], [1, 0, -1], [1, 1, -1]], speed_m_s: 0.8";
  const auto first_leg_deviation = [&](const std::string& shape) {
    const MissionFile file = parse(kHead + kTakeoff + "  - {kind: path, " + corner + shape + "}\n" + kLand);
    EXPECT_TRUE(file.mission.items[1].yaw_free);
    double greatest = 0.0;
    for (const control::PolynomialSegment& segment : file.mission.segments) {
      for (double t = 0.0; t < segment.duration_s; t += 0.01) {
        const Eigen::Vector3d p = control::evaluate(segment, t).position_ned;
        if (p.x() < 0.9) greatest = std::max(greatest, std::abs(p.y()));
      }
    }
    return greatest;
  };
  EXPECT_GT(first_leg_deviation(""), 0.05);
  EXPECT_LT(first_leg_deviation(", corridor_m: 0.03"), 0.0301);
  EXPECT_LT(first_leg_deviation(", straight: true"), 1e-9);
}

// GIVEN a trajectory that is too fast WHEN the mission is flown slower by --time-scale THEN the limits apply to what is flown.
TEST(MissionFile, TrajectoriesKeepToTheLimitsAsTheyAreFlown) {
  const tests::TemporaryFolder folder;
  std::string samples = "t,x,y,z\n";
  for (int i = 0; i <= 100; ++i) {
    const double s = i / 100.0;
    samples += fmt::format("{:.2f},{:.6f},0,1\n", s, 1.5 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s));
  }
  folder.write("fast.csv", samples);
  const std::string path = folder.write(
      "m.yaml", kHead + kTakeoff + "  - {kind: trajectory, file: fast.csv, speed_m_s: 0.5}\n" + kLand);
  FileOptions options;
  EXPECT_THROW(load_mission_file(path, control::Limits{}, options), io::ConfigError);
  options.time_scale = 3.0;
  const MissionFile file = load_mission_file(path, control::Limits{}, options);
  double duration_s = 0.0;
  for (const control::PolynomialSegment& segment : file.mission.segments) duration_s += segment.duration_s;
  EXPECT_NEAR(duration_s, 3.0, 1e-9);
}

TEST(MissionFile, LoadsTrajectoriesFromFilesBesideIt) {
  const tests::TemporaryFolder folder;
  folder.write("samples.csv", "t,x,y,z\n0,0,0,1\n1,0.3,0,1\n2,0.6,0.2,1.1\n4,1,0,1\n");
  const std::string path = folder.write(
      "m.yaml", kHead + kTakeoff +
                    "  - {kind: trajectory, file: samples.csv, yaw_rad: free, speed_m_s: 0.5}\n" +
                    "  - {kind: path, points: [[0, 1, -1], [0, 0, -1]], speed_m_s: 0.5}\n" + kLand);
  const MissionFile file = load_mission_file(path, control::Limits{});
  const auto& items = file.mission.items;
  ASSERT_EQ(items.size(), 4U);
  EXPECT_GE(items[1].segment_count, 3U);
  EXPECT_TRUE(items[1].yaw_free);
  EXPECT_EQ(items[2].first_segment, items[1].segment_count);
  EXPECT_EQ(file.mission.segments.size(), items[1].segment_count + items[2].segment_count);
  ASSERT_FALSE(file.assumptions.empty());
  EXPECT_EQ(file.assumptions[0].find("samples.csv: taken as a sampled trajectory in ENU"), 0U);
  EXPECT_TRUE(control::check(
                  [&] {
                    control::Mission mission = file.mission;
                    mission.id = 1;
                    return mission;
                  }(),
                  control::Limits{})
                  .accepted);
}

TEST(MissionFile, ConvertsTheFenceToNed) {
  const MissionFile file = parse(
      "geofence: {min_m: [-1, -2, -0.1], max_m: [2, 2.5, 1.8]}\nframe: enu\ntolerance_m: 0.1\nitems:\n" +
      kTakeoff + kLand);
  ASSERT_TRUE(file.mission.bounds.fenced);
  EXPECT_EQ(file.mission.bounds.fence_min_ned, Eigen::Vector3d(-2, -1, -1.8));
  EXPECT_EQ(file.mission.bounds.fence_max_ned, Eigen::Vector3d(2.5, 2, 0.1));
}

class BadMissionFile : public testing::TestWithParam<tests::Fault> {};

TEST_P(BadMissionFile, IsRefusedWithASentence) { EXPECT_EQ(refusal(GetParam().text), GetParam().sentence); }

INSTANTIATE_TEST_SUITE_P(
    , BadMissionFile,
    testing::Values(
        tests::Fault{"OutsideTheFence",
                     kHead + kTakeoff + "  - {kind: waypoint, position_m: [0, 7.5, -1], speed_m_s: 0.5}\n",
                     "m.yaml:5: items[1].position_m: east is 7.5 m, must be inside the fence, -3 to 3 m"},
        tests::Fault{"TooHigh", kHead + "  - {kind: takeoff, height_m: 9, speed_m_s: 0.5}\n",
                     "m.yaml:4: items[0].height_m: down is -9 m, must be inside the fence, -2.5 to 0 m"},
        tests::Fault{
            "BelowTheGroundInEnu",
            "frame: enu\ntolerance_m: 0.1\nitems:\n" + kTakeoff +
                "  - {kind: waypoint, position_m: [1, 0, -0.2], speed_m_s: 0.5}\n",
            "m.yaml:5: items[1].position_m: in ENU: z = -0.200 m is below the ground, as z points up (ENU); "
            "0.200 m above the ground is z = 0.200 m"},
        tests::Fault{"TooHighInEnu",
                     "frame: enu\ntolerance_m: 0.1\nitems:\n" + kTakeoff +
                         "  - {kind: waypoint, position_m: [1, 0, 9], speed_m_s: 0.5}\n",
                     "m.yaml:5: items[1].position_m: up is 9 m, must be inside the fence, 0 to 2.5 m"},
        tests::Fault{"TooFast", kHead + kTakeoff + "  - {kind: land, speed_m_s: 4}\n",
                     "m.yaml:5: items[1].speed_m_s: is 4, must be above 0 and at most 2"},
        tests::Fault{"NotANumber",
                     kHead + kTakeoff + "  - {kind: waypoint, position_m: [.nan, 0, -1], speed_m_s: 0.5}\n",
                     "m.yaml:5: items[1].position_m[0]: is .nan, must be a finite number"},
        tests::Fault{"NegativeHold", kHead + "  - {kind: takeoff, height_m: 1, speed_m_s: 0.5, hold_s: -1}\n",
                     "m.yaml:4: items[0].hold_s: is -1, must be at least 0 and at most 3600"},
        tests::Fault{
            "UnknownKind", kHead + "  - {kind: loop, speed_m_s: 0.5}\n",
            "m.yaml:4: items[0].kind: is loop, must be takeoff, waypoint, path, trajectory, set, wait or "
            "land"},
        tests::Fault{"LateTakeoff", kHead + kTakeoff + kTakeoff,
                     "m.yaml:5: items[1]: is a takeoff, which must be the first item"},
        tests::Fault{"EarlyLand", kHead + kTakeoff + kLand + kWaypoint,
                     "m.yaml:6: items[2]: comes after a land, which must be the last item"},
        tests::Fault{"NoItems", "frame: ned\ntolerance_m: 0.1\nitems: []\n",
                     "m.yaml:3: items: is a list of 0, must be a list of 1 to 2048"},
        tests::Fault{"UnknownFrame", "frame: body\ntolerance_m: 0.1\nitems:\n" + kTakeoff,
                     "m.yaml:1: frame: is body, must be ned, enu or nwu"},
        tests::Fault{"NoTolerance", "frame: ned\nitems:\n" + kTakeoff,
                     "m.yaml:1: tolerance_m: is missing, must be given"},
        tests::Fault{"ZeroTolerance", "frame: ned\ntolerance_m: 0\nitems:\n" + kTakeoff,
                     "m.yaml:2: tolerance_m: is 0, must be above 0 and at most 10"},
        tests::Fault{
            "MisspeltKey", kHead + "  - {kind: takeoff, height_m: 1, speed_m_s: 0.5, hold: 2}\n",
            "m.yaml:4: items[0].hold: is unknown, must be one of kind, height_m, position_m, points, file, "
            "duration_s, yaw_rad, yaw_deg, speed_m_s, acceptance_radius_m, hold_s, straight, corridor_m or "
            "smoothness; "
            "nearest is hold_s"},
        tests::Fault{
            "KeyOfAnotherKind", kHead + "  - {kind: takeoff, height_m: 1, speed_m_s: 0.5, yaw_rad: 2}\n",
            "m.yaml:4: items[0].yaw_rad: is unknown, must be one of kind, height_m, speed_m_s or hold_s"},
        tests::Fault{
            "MisspeltRequiredKey",
            kHead + kTakeoff + "  - {kind: waypoint, positon_m: [1, 0, -1], speed_m_s: 1}\n",
            "m.yaml:5: items[1].positon_m: is unknown, must be one of kind, height_m, position_m, points, "
            "file, "
            "duration_s, yaw_rad, yaw_deg, speed_m_s, acceptance_radius_m, hold_s, straight, corridor_m or "
            "smoothness; "
            "nearest is position_m"},
        tests::Fault{
            "MisspeltKind", kHead + "  - {knd: takeoff, height_m: 1, speed_m_s: 0.5}\n",
            "m.yaml:4: items[0].knd: is unknown, must be one of kind, height_m, position_m, points, file, "
            "duration_s, yaw_rad, yaw_deg, speed_m_s, acceptance_radius_m, hold_s, straight, corridor_m or "
            "smoothness; "
            "nearest is kind"},
        tests::Fault{
            "MisspeltRootKey", "fram: ned\ntolerance_m: 0.1\nitems:\n" + kTakeoff + kLand,
            "m.yaml:1: fram: is unknown, must be one of name, description, frame, tolerance_m, limits, "
            "geofence, "
            "ends or items; nearest is frame"},
        tests::Fault{"KeyTwice", kHead + "  - {kind: takeoff, height_m: 1, height_m: 2, speed_m_s: 0.5}\n",
                     "m.yaml:4: items[0].height_m: is given twice, first in line 4"},
        tests::Fault{"NoSpeed", kHead + "  - {kind: takeoff, height_m: 1}\n" + kLand,
                     "m.yaml:4: items[0].speed_m_s: is missing, must be given"},
        tests::Fault{
            "EmptySet", kHead + "  - {kind: set}\n" + kLand,
            "m.yaml:4: items[0]: sets nothing, must give one of speed_m_s, yaw_rad, acceptance_radius_m or "
            "hold_s"},
        tests::Fault{"NoItemToFly", kHead + "  - {kind: set, speed_m_s: 1}\n",
                     "m.yaml:3: items: has no item to fly, must have at least one besides set"},
        tests::Fault{
            "NoLanding", kHead + kTakeoff + kWaypoint,
            "m.yaml:5: items[1]: is the last item, which must be a land unless the mission has `ends: "
            "hovering`"},
        tests::Fault{"LandsButEndsHovering", kHovers + kTakeoff + kLand,
                     "m.yaml:1: ends: is hovering, must be landed: the last item is a land"},
        tests::Fault{"LooserLimit", "limits: {speed_m_s: 2.5}\n" + kHead + kTakeoff + kLand,
                     "m.yaml:1: limits.speed_m_s: is 2.5, must be above 0 and at most 2"},
        tests::Fault{"MisspeltLimit", "limits: {spede_m_s: 1}\n" + kHead + kTakeoff + kLand,
                     "m.yaml:1: limits.spede_m_s: is unknown, must be one of speed_m_s, acceleration_m_s2, "
                     "jerk_m_s3 or "
                     "yaw_rate_rad_s; nearest is speed_m_s"},
        tests::Fault{"FasterThanItsOwnLimit", "limits: {speed_m_s: 0.4}\n" + kHead + kTakeoff + kLand,
                     "m.yaml:5: items[0].speed_m_s: is 0.5, must be above 0 and at most 0.4"},
        tests::Fault{
            "LooserFence", "geofence: {min_m: [-9, -1, -2], max_m: [1, 1, 0.2]}\n" + kHead + kTakeoff + kLand,
            "m.yaml:1: geofence: the mission's fence, minimum corner: x is -9.000 m, outside the fence "
            "of -3.000 "
            "to 3.000 m"},
        tests::Fault{"EmptyFence",
                     "geofence: {min_m: [-1, 1, -2], max_m: [1, 1, 0.2]}\n" + kHead + kTakeoff + kLand,
                     "m.yaml:1: geofence.max_m: number 2 is 1, must be above that of min_m, 1"},
        tests::Fault{
            "OutsideItsOwnFence",
            "geofence: {min_m: [-1, -1, -2], max_m: [1, 1, 0.2]}\n" + kHead + kTakeoff + kWaypoint + kLand,
            "m.yaml:6: items[1].position_m: north is 2 m, must be inside the fence, -1 to 1 m"},
        tests::Fault{"KeyAfterTheItems", kHead + kTakeoff + kLand + "name: late\n",
                     "m.yaml:6: name: stands after items, must stand before them: a truncated file would "
                     "lose it silently"},
        tests::Fault{"PathOfOnePoint",
                     kHead + kTakeoff + "  - {kind: path, points: [[1, 0, -1]], speed_m_s: 1}\n",
                     "m.yaml:5: items[1].points: is a list of 1, must be a list of 2 to 1025"},
        tests::Fault{"PathOutsideTheFence",
                     kHead + kTakeoff + "  - {kind: path, points: [[1, 0, -1], [7, 0, -1]], speed_m_s: 1}\n",
                     "m.yaml:5: items[1].points[1]: north is 7 m, must be inside the fence, -3 to 3 m"},
        tests::Fault{"StraightCorridor",
                     kHead + kTakeoff +
                         "  - {kind: path, points: [[1, 0, -1], [2, 0, -1]], speed_m_s: 1, straight: true, "
                         "corridor_m: 1}\n",
                     "m.yaml:5: items[1].corridor_m: is given for a path of straight legs, must be left out"},
        tests::Fault{
            "YawNotANumber",
            kHead + kTakeoff + "  - {kind: waypoint, position_m: [1, 0, -1], speed_m_s: 1, yaw_rad: north}\n",
            "m.yaml:5: items[1].yaw_rad: is north, must be a number"},
        tests::Fault{
            "YawInDegrees",
            kHead + kTakeoff + "  - {kind: waypoint, position_m: [1, 0, -1], speed_m_s: 1, yaw_rad: 180}\n",
            "m.yaml:5: items[1].yaw_rad: is 180, must be at least -3.14159 and at most 3.14159: 180 degrees "
            "are "
            "3.1416 rad, yaw_deg takes degrees"},
        tests::Fault{
            "YawTwice",
            kHead + kTakeoff +
                "  - {kind: waypoint, position_m: [1, 0, -1], speed_m_s: 1, yaw_rad: 1, yaw_deg: 57}\n",
            "m.yaml:5: items[1].yaw_deg: is given beside yaw_rad, must be one of both"},
        tests::Fault{
            "RadiusBelowZero",
            kHead + kTakeoff +
                "  - {kind: waypoint, position_m: [1, 0, -1], speed_m_s: 1, acceptance_radius_m: -1}\n",
            "m.yaml:5: items[1].acceptance_radius_m: is -1, must be at least 0 and at most 10"},
        tests::Fault{"EmptyWait", kHead + kTakeoff + "  - {kind: wait, duration_s: 0}\n",
                     "m.yaml:5: items[1].duration_s: is 0, must be above 0 and at most 3600"},
        tests::Fault{"MissingTrajectory",
                     kHead + kTakeoff + "  - {kind: trajectory, file: none.csv, speed_m_s: 1}\n",
                     "m.yaml:5: items[1].file: is none.csv, must be an existing file: looked for none.csv"},
        tests::Fault{"NameWithAFolder", "name: ../x\n" + kHead + kTakeoff,
                     "m.yaml:1: name: must be at most 64 characters and hold no /"}),
    tests::name_of);

TEST(MissionFile, ReadsDegreesWhereTheKeySaysSo) {
  const MissionFile file =
      parse(kHead + kTakeoff + "  - {kind: waypoint, position_m: [1, 0, -1], speed_m_s: 1, yaw_deg: 180}\n" +
            "  - {kind: set, yaw_deg: -45}\n  - {kind: waypoint, position_m: [2, 0, -1], speed_m_s: 1}\n" +
            "  - {kind: path, speed_m_s: 1, points: [[2, 0, -1], {position_m: [2, 1, -1], yaw_deg: 90}]}\n" +
            kLand);
  EXPECT_NEAR(std::abs(file.mission.items[1].yaw_rad), M_PI, 1e-12);
  EXPECT_NEAR(file.mission.items[2].yaw_rad, -M_PI / 4, 1e-12);
  const control::PolynomialSegment& last = file.mission.segments.back();
  EXPECT_NEAR(control::evaluate(last, last.duration_s).yaw_rad, M_PI / 2, 1e-9);
}

TEST(MissionFile, RefusesEveryTruncation) {
  const std::string whole =
      "limits: {speed_m_s: 1}\ngeofence: {min_m: [-1, -2, -2], max_m: [2.5, 1, 0.2]}\n" + kHead + kTakeoff +
      kWaypoint + kLand;
  ASSERT_EQ(refusal(whole), "it was accepted");
  for (std::size_t length = 1; length < whole.size(); ++length) {
    const std::string text = whole.substr(0, length);
    EXPECT_NE(refusal(text), "it was accepted") << text;
  }
}

TEST(PlannedDuration, IsTheSumOfMinimumJerkMovesAndHolds) {
  const MissionFile file =
      parse(kHead + kTakeoff + "  - {kind: waypoint, position_m: [2, 0, -1], speed_m_s: 0.5}\n" +
            "  - {kind: land, speed_m_s: 0.5}\n");
  // 15/8 d/T is the peak speed of such a move.
  EXPECT_NEAR(planned_duration_s(file.mission, control::Limits{}), 3.75 + 2.0 + 7.5 + 3.75, 1e-9);
}

TEST(PlannedDuration, IncludesTheYawTurn) {
  const MissionFile file =
      parse(kHovers + "  - {kind: takeoff, height_m: 1, speed_m_s: 0.5}\n" +
            "  - {kind: waypoint, position_m: [0, 0, -1], yaw_rad: 3, speed_m_s: 0.5}\n");
  const control::Limits limits;
  EXPECT_NEAR(planned_duration_s(file.mission, limits), 3.75 + 15.0 / 8.0 * 3.0 / limits.max_yaw_rate, 1e-9);
}

class PaperMission : public testing::TestWithParam<const char*> {};

TEST_P(PaperMission, TakesAboutFortySecondsWithinTheFigureAxes) {
  const MissionFile file =
      load_mission_file(tests::in_source("config/missions/") + GetParam() + ".yaml", control::Limits{});
  EXPECT_EQ(file.name, GetParam());
  EXPECT_TRUE(file.takes_off());
  EXPECT_TRUE(file.lands());
  EXPECT_NEAR(planned_duration_s(file.mission, control::Limits{}), 40.0, 2.5);
  for (const control::MissionItem& item : file.mission.items) {
    EXPECT_LE(item.position_ned.head<2>().cwiseAbs().maxCoeff(), 2.0);
    EXPECT_LE(item.position_ned.z(), 0.0);
    EXPECT_GE(item.position_ned.z(), -2.0);
    EXPECT_LE(item.speed, 0.5);
  }
}

INSTANTIATE_TEST_SUITE_P(, PaperMission, testing::Values("square", "zigzag"));

}  // namespace swiftlet::io::mission_file_test
