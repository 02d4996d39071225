#include "ground/mission_file.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "services/runtime/config_error.hpp"
#include "tests/unit/ground/fault.hpp"

namespace swiftlet::ground {
namespace {

using control::MissionItemKind;

const std::string kHead = "frame: ned\ntolerance_m: 0.1\nitems:\n";
const std::string kTakeoff = "  - {kind: takeoff, height_m: 1.0, speed_m_s: 0.5, hold_s: 2}\n";
const std::string kWaypoint = "  - {kind: waypoint, position_m: [2, -1, -1.5], speed_m_s: 0.5}\n";
const std::string kLand = "  - {kind: land, speed_m_s: 0.3}\n";

MissionFile parse(const std::string& text) { return parse_mission_file(text, "m.yaml", control::Limits{}); }

std::string refusal(const std::string& text) {
  try {
    parse(text);
  } catch (const runtime::ConfigError& error) {
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

TEST(MissionFile, IsNamedAfterTheFileUnlessItSays) { EXPECT_EQ(parse(kHead + kTakeoff).name, "m"); }

TEST(MissionFile, TurnsEnuIntoNed) {
  const MissionFile file = parse(
      "frame: enu\ntolerance_m: 0.1\nitems:\n"
      "  - {kind: takeoff, height_m: 1.0, speed_m_s: 0.5}\n"
      "  - {kind: waypoint, position_m: [1, 2, 1.5], yaw_rad: 0, speed_m_s: 0.5}\n"
      "  - {kind: waypoint, position_m: [1, 2, 1.5], yaw_rad: -3, speed_m_s: 0.5}\n");
  const auto& items = file.mission.items;
  EXPECT_DOUBLE_EQ(items[0].position_ned.z(), -1.0);
  EXPECT_TRUE(items[1].position_ned.isApprox(Eigen::Vector3d(2, 1, -1.5)));
  EXPECT_NEAR(items[1].yaw_rad, M_PI / 2, 1e-12) << "east";
  EXPECT_NEAR(items[2].yaw_rad, M_PI / 2 + 3.0 - 2 * M_PI, 1e-12);
}

class BadMissionFile : public testing::TestWithParam<Fault> {};

TEST_P(BadMissionFile, IsRefusedWithASentence) { EXPECT_EQ(refusal(GetParam().text), GetParam().sentence); }

INSTANTIATE_TEST_SUITE_P(
    , BadMissionFile,
    testing::Values(
        Fault{"OutsideTheFence",
              kHead + kTakeoff + "  - {kind: waypoint, position_m: [0, 7.5, -1], speed_m_s: 0.5}\n",
              "m.yaml:5: items[1].position_m: east is 7.5 m, must be inside the fence, -3 to 3 m"},
        Fault{"TooHigh", kHead + "  - {kind: takeoff, height_m: 9, speed_m_s: 0.5}\n",
              "m.yaml:4: items[0].height_m: down is -9 m, must be inside the fence, -2.5 to 0.2 m"},
        Fault{"TooFast", kHead + kTakeoff + "  - {kind: land, speed_m_s: 4}\n",
              "m.yaml:5: items[1].speed_m_s: is 4, must be above 0 and at most 2"},
        Fault{"NotANumber",
              kHead + kTakeoff + "  - {kind: waypoint, position_m: [.nan, 0, -1], speed_m_s: 0.5}\n",
              "m.yaml:5: items[1].position_m[0]: is .nan, must be a finite number"},
        Fault{"NegativeHold", kHead + "  - {kind: takeoff, height_m: 1, speed_m_s: 0.5, hold_s: -1}\n",
              "m.yaml:4: items[0].hold_s: is -1, must be at least 0 and at most 3600"},
        Fault{"UnknownKind", kHead + "  - {kind: loop, speed_m_s: 0.5}\n",
              "m.yaml:4: items[0].kind: is loop, must be takeoff, waypoint or land"},
        Fault{"LateTakeoff", kHead + kTakeoff + kTakeoff,
              "m.yaml:5: items[1]: is a takeoff, which must be the first item"},
        Fault{"EarlyLand", kHead + kTakeoff + kLand + kWaypoint,
              "m.yaml:5: items[1]: is a land, which must be the last item"},
        Fault{"NoItems", "frame: ned\ntolerance_m: 0.1\nitems: []\n",
              "m.yaml:3: items: is a list of 0, must be a list of 1 to 2048"},
        Fault{"UnknownFrame", "frame: body\ntolerance_m: 0.1\nitems:\n" + kTakeoff,
              "m.yaml:1: frame: is body, must be ned or enu"},
        Fault{"NoTolerance", "frame: ned\nitems:\n" + kTakeoff,
              "m.yaml:1: tolerance_m: is missing, must be given"},
        Fault{"ZeroTolerance", "frame: ned\ntolerance_m: 0\nitems:\n" + kTakeoff,
              "m.yaml:2: tolerance_m: is 0, must be above 0 and at most 10"},
        Fault{"MisspeltKey", kHead + "  - {kind: takeoff, height_m: 1, speed_m_s: 0.5, hold: 2}\n",
              "m.yaml:4: items[0].hold: is unknown, must be one of kind, height_m, speed_m_s or hold_s"},
        Fault{"NameWithAFolder", "name: ../x\n" + kHead + kTakeoff,
              "m.yaml:1: name: must be at most 64 characters and hold no /"}),
    name_of);

TEST(MissionFile, RefusesOneThatIsCutShort) {
  const std::string whole = kHead + kTakeoff + kWaypoint + kLand;
  for (std::size_t length = 1; length + 1 < whole.size(); ++length) {
    const std::string text = whole.substr(0, length);
    const bool ends_with_a_line = text.back() == '\n';
    const bool has_an_item = text.find("hold_s: 2}\n") != std::string::npos;
    if (ends_with_a_line && has_an_item) continue;  // a shorter mission, but a whole one
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

TEST(PlannedDuration, WaitsForTheYaw) {
  const MissionFile file =
      parse(kHead + "  - {kind: takeoff, height_m: 1, speed_m_s: 0.5}\n" +
            "  - {kind: waypoint, position_m: [0, 0, -1], yaw_rad: 3, speed_m_s: 0.5}\n");
  const control::Limits limits;
  EXPECT_NEAR(planned_duration_s(file.mission, limits), 3.75 + 15.0 / 8.0 * 3.0 / limits.max_yaw_rate, 1e-9);
}

class PaperMission : public testing::TestWithParam<const char*> {};

TEST_P(PaperMission, TakesAboutFortySecondsInsideTheFiguresAxes) {
  const MissionFile file = load_mission_file(
      std::string(SWIFTLET_SOURCE_DIR "/config/missions/") + GetParam() + ".yaml", control::Limits{});
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

}  // namespace
}  // namespace swiftlet::ground
