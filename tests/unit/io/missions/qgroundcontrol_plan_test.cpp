#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "tests/unit/fault.hpp"
#include "tests/unit/io/missions/format_support.hpp"

namespace swiftlet::io::qgroundcontrol_plan_test {

using control::MissionItemKind;
using Eigen::Vector3d;

std::string item(int command, int frame, const std::string& params) {
  return "{\"type\": \"SimpleItem\", \"command\": " + std::to_string(command) +
         ", \"frame\": " + std::to_string(frame) + ", \"params\": [" + params + "], \"autoContinue\": true}";
}
std::string plan(const std::string& items, const std::string& home = "47.4, 8.5, 488") {
  return "{\n\"fileType\": \"Plan\", \"version\": 1,\n\"mission\": {\"hoverSpeed\": 0.8, "
         "\"plannedHomePosition\": [" +
         home + "],\n\"items\": [\n" + items + "\n]}}\n";
}
const std::string kUp = item(22, 1, "0,0,0,null,null,null,-1");
MissionFile qgc(const std::string& text, const control::Limits& limits = control::Limits()) {
  return parse_any_mission_file(text, "q.plan", limits);
}

TEST(QGroundControlPlan, ReadsThePx4BoxMission) {
  const MissionFile file = load_mission_file(kData + "px4_mission_box.plan", field());
  const auto& items = file.mission.items;
  ASSERT_EQ(items.size(), 7U);
  EXPECT_EQ(items[0].kind, MissionItemKind::kTakeoff);
  EXPECT_EQ(items[0].position_ned.z(), -5.0);
  EXPECT_EQ(items[1].kind, MissionItemKind::kWaypoint);
  // 1.3088e-4 deg of latitude are 14.55 m at 47.4 deg; of longitude, 2.5e-4 deg are 19.0 m.
  EXPECT_NEAR(items[1].position_ned.x(), 14.55, 0.02);
  EXPECT_NEAR(items[2].position_ned.y(), -19.05, 0.05);
  EXPECT_EQ(items[2].position_ned.z(), -10.0);
  EXPECT_TRUE(items[1].yaw_free);
  EXPECT_EQ(items[1].speed, 0.5) << "hoverSpeed is a setting of its estimate";
  EXPECT_LT((items[5].position_ned - items[4].position_ned).norm(), 0.1);  // above where it lands
  EXPECT_EQ(items[6].kind, MissionItemKind::kLand);
  EXPECT_TRUE(assumes(file, "home, 47.3977420, 8.5455940 deg and 488.0 m, is the origin"));
  EXPECT_TRUE(assumes(file, "hoverSpeed and cruiseSpeed of the plan are for the estimate"));
  EXPECT_TRUE(assumes(file, "the plan says 0.40 m away"));
  EXPECT_TRUE(control::check(file.mission, field()).accepted) << control::check(file.mission, field()).reason;
}

TEST(QGroundControlPlan, ReadsLocalCoordinatesInBothFrames) {
  const MissionFile file =
      qgc(plan(item(22, 1, "0,0,0,null,null,null,-1") + "," + item(16, 1, "2.5,0,0,90,1,2,-1.5") + "," +
               item(178, 2, "1,0.4,-1,0,0,0,0") + "," + item(16, 4, "0,0,0,null,1,2,1.5") + "," +
               item(19, 4, "3,0,0,null,0,0,1.5")));
  const auto& items = file.mission.items;
  ASSERT_EQ(items.size(), 5U);
  EXPECT_EQ(items[1].position_ned, Vector3d(1, 2, -1.5));
  EXPECT_EQ(items[1].hold_s, 2.5);
  EXPECT_FALSE(items[1].yaw_free);
  EXPECT_NEAR(items[1].yaw_rad, M_PI / 2, 1e-12);
  EXPECT_EQ(items[1].speed, 0.5);
  EXPECT_EQ(items[2].position_ned, Vector3d(2, 1, -1.5));
  EXPECT_EQ(items[2].speed, 0.4);
  EXPECT_EQ(items[3].hold_s, 3.0);
  EXPECT_EQ(items[4].kind, MissionItemKind::kLand);
  EXPECT_TRUE(assumes(file, "local coordinates"));
  EXPECT_TRUE(assumes(file, "a landing is added"));
}

TEST(QGroundControlPlan, ConvertsSeaLevelAltitudesToHeightsAboveHome) {
  const MissionFile file = qgc(plan(item(16, 0, "0,0,0,null,47.4,8.50001,489.5")));
  ASSERT_EQ(file.mission.items.size(), 3U);  // take-off and landing are added
  EXPECT_EQ(file.mission.items[0].kind, MissionItemKind::kTakeoff);
  EXPECT_NEAR(file.mission.items[1].position_ned.z(), -1.5, 1e-9);
  EXPECT_NEAR(file.mission.items[1].position_ned.y(), 0.755, 0.002);
}

TEST(QGroundControlPlan, ConvertsReturnToLaunch) {
  const MissionFile file = qgc(plan(item(22, 1, "0,0,0,null,null,null,-1") + "," +
                                    item(16, 1, "0,0,0,null,1,1,-1") + "," + item(20, 2, "0,0,0,0,0,0,0")));
  ASSERT_EQ(file.mission.items.size(), 4U);
  EXPECT_EQ(file.mission.items[2].position_ned, Vector3d(0, 0, -1));
  EXPECT_EQ(file.mission.items[3].kind, MissionItemKind::kLand);
}

TEST(QGroundControlPlan, ReadsWhatElseACommandSays) {
  const MissionFile file =
      qgc(plan(item(22, 1, "15,0,0,null,null,null,-1") + "," + item(178, 2, "0,9,-1,0,0,0,0") + "," +
               item(16, 1, "0,0.3,0,null,1,1,-1") + "," + item(178, 2, "1,-2,-1,0,0,0,0") + "," +
               item(178, 2, "1,-1,-1,0,0,0,0") + "," + item(19, 1, "2,1,50,1,1,1,-1")));
  ASSERT_EQ(file.mission.items.size(), 4U);
  EXPECT_EQ(file.mission.items[1].acceptance_radius_m, 0.3);
  EXPECT_EQ(file.mission.items[1].speed, 2.0);
  EXPECT_TRUE(assumes(file, "the plan wants 9 m/s"));
  EXPECT_EQ(file.mission.items[2].speed, 0.5) << "-2 is the default";
  EXPECT_TRUE(file.mission.items[2].yaw_free) << "parameter 4 of command 19 is no yaw";
  EXPECT_EQ(file.mission.items[2].hold_s, 2.0);
  EXPECT_TRUE(
      assumes(file, "for aeroplanes, not used: parameter 1 of 22 (take-off), 2 of 19 (loiter for a time)"));
}

TEST(QGroundControlPlan, ReadsPlaceZeroAsHere) {
  const std::string up = item(22, 3, "0,0,0,0,0,0,1") + "," + item(16, 3, "0,0,0,null,47.40001,8.5,1");
  const MissionFile file = qgc(plan(up + "," + item(21, 3, "0,0,0,0,0,0,0")));
  ASSERT_EQ(file.mission.items.size(), 3U) << "it lands where it is";
  EXPECT_NEAR(file.mission.items[1].position_ned.x(), 1.11, 0.01);
  EXPECT_TRUE(assumes(file, "latitude and longitude 0 of items 1 and 3 mean here"));
  EXPECT_EQ(qgc(plan(kUp + "," + item(16, 1, "0,0,0,null,1,1,-1") + "," + item(21, 1, "0,0,0,0,0,0,0")))
                .mission.items[2]
                .position_ned,
            Vector3d(0, 0, -1))
      << "local coordinates of 0 are home";
}

TEST(QGroundControlPlan, AcceptsAnyWhiteSpace) {
  std::string text = plan(item(16, 1, "0,0,0,null,1,1,-1"));
  std::string tight;
  for (const char c : text) {
    if (c != ' ' && c != '\n') tight += c;
  }
  EXPECT_EQ(qgc(tight).mission.items.size(), 3U);
  for (char& c : text) c = c == ' ' ? '\t' : c;
  EXPECT_EQ(qgc(text).mission.items.size(), 3U);
}

class BadPlan : public testing::TestWithParam<tests::Fault> {};
TEST_P(BadPlan, IsRefusedWithASentence) {
  EXPECT_EQ(refusal([] { qgc(GetParam().text); }), GetParam().sentence);
}
INSTANTIATE_TEST_SUITE_P(
    , BadPlan,
    testing::Values(
        tests::Fault{"empty", "", "q.plan:1: column 1: the file is empty, must be a JSON document"},
        tests::Fault{"truncated", "{\n \"fileType\": \"Plan\",\n \"mission",
                     "q.plan:3: column 9: is invalid JSON"},
        tests::Fault{"number_overflow", plan(item(16, 1, "0,0,0,null,1e309,1,-1")),
                     "q.plan: holds a number beyond 1.8e308, must hold smaller ones"},
        tests::Fault{"other_file_type", "{\"fileType\": \"Fence\"}",
                     "q.plan:1: fileType: is Fence, must be Plan"},
        tests::Fault{"no_items", plan(""),
                     "q.plan:4: mission.items: is a list of 0, must be a list of 1 to 2048"},
        tests::Fault{
            "unsupported_command", plan(kUp + ",\n" + item(206, 2, "1,2,3,4,5,6,7")),
            "q.plan:6: mission.items[1].command: is 206, must be 16 (waypoint), 19 (loiter for a time), 20 "
            "(return to "
            "launch), 21 (land), 22 (take-off) or 178 (change speed)"},
        tests::Fault{
            "complex_item", plan("{\"type\": \"ComplexItem\"}"),
            "q.plan:5: mission.items[0].type: is ComplexItem, must be SimpleItem: draw the pattern as "
            "waypoints"},
        tests::Fault{
            "unknown_frame", plan(item(16, 10, "0,0,0,null,1,1,1")),
            "q.plan:5: mission.items[0].frame: is 10, must be 0 or 3 (global, altitude above the sea or "
            "above home), 1 (local "
            "NED) or 4 (local ENU)"},
        tests::Fault{"six_parameters", plan(item(16, 1, "0,0,0,null,1,1")),
                     "q.plan:5: mission.items[0].params: is a list of 6, must be a list of 7"},
        tests::Fault{"no_latitude", plan(item(16, 3, "0,0,0,null,null,8.5,1")),
                     "q.plan:5: mission.items[0].params[4]: is empty, must be a number"},
        tests::Fault{"latitude_out_of_range", plan(item(16, 3, "0,0,0,null,90.5,8.5,1")),
                     "q.plan:5: mission.items[0].params[4]: is 90.5, must be at least -90 and at most 90"},
        tests::Fault{
            "home_out_of_range", plan(kUp, "47, 181, 0"),
            "q.plan:3: mission.plannedHomePosition[1]: is 181, must be at least -180 and at most 180"},
        tests::Fault{"outside_the_fence", plan(kUp + ",\n" + item(16, 1, "0,0,0,null,3.5,1,-1")),
                     "q.plan:6: mission.items[1]: north is 3.5 m, must be inside the fence, -3 to 3 m"},
        tests::Fault{
            "takes_off_elsewhere", plan(item(22, 1, "0,0,0,null,2,0,-1")),
            "q.plan:5: mission.items[0]: takes off 2.0 m from home, must be at most 1 m: the vehicle stands "
            "at home"},
        tests::Fault{"lands_first", plan(item(21, 1, "0,0,0,null,0,0,0")),
                     "q.plan:5: mission.items[0]: is the first item, must follow a take-off or a waypoint"},
        tests::Fault{
            "item_after_landing",
            plan(kUp + ",\n" + item(21, 1, "0,0,0,null,0,0,0") + ",\n" + item(16, 1, "0,0,0,null,0,0,-1")),
            "q.plan:7: mission.items[2]: follows a landing, which must be the last item"},
        tests::Fault{"hold_above_limit", plan(item(16, 1, "3601,0,0,null,1,1,-1")),
                     "q.plan:5: mission.items[0].params[0]: is 3601, must be at least 0 and at most 3600"},
        tests::Fault{"zero_speed", plan(item(178, 2, "1,0,-1,0,0,0,0")),
                     "q.plan:5: mission.items[0].params[1]: is 0, must be above 0"},
        tests::Fault{"climb_speed", plan(item(178, 2, "2,0.4,-1,0,0,0,0")),
                     "q.plan:5: mission.items[0].params[0]: is 2, must be 0 or 1, a speed of flight: a speed "
                     "of climb or "
                     "descent is not read"},
        tests::Fault{"relative_speed", plan(item(178, 2, "1,0.4,-1,1,0,0,0")),
                     "q.plan:5: mission.items[0].params[3]: is 1, must be 0 or empty: parameter 4 of 178 "
                     "(change speed) is "
                     "not read"},
        tests::Fault{
            "throttle", plan(item(178, 2, "1,0.4,50,0,0,0,0")),
            "q.plan:5: mission.items[0].params[2]: is 50, must be -1, 0 or empty: a throttle is not read"},
        tests::Fault{"pass_radius", plan(item(16, 1, "0,0,2,null,1,1,-1")),
                     "q.plan:5: mission.items[0].params[2]: is 2, must be 0 or empty: parameter 3 of 16 "
                     "(waypoint) is not "
                     "read"},
        tests::Fault{"yaw_of_a_landing", plan(kUp + ",\n" + item(21, 1, "0,0,0,90,0,0,0")),
                     "q.plan:6: mission.items[1].params[3]: is 90, must be 0 or empty: parameter 4 of 21 "
                     "(land) is not "
                     "read"},
        tests::Fault{"lands_on_a_roof", plan(kUp + ",\n" + item(21, 1, "0,0,0,0,0,0,-3")),
                     "q.plan:6: mission.items[1].params[6]: is 3 m above home, must be within 0.1 m: the "
                     "vehicle lands on "
                     "the ground"},
        tests::Fault{"no_item_to_fly", plan(item(178, 2, "1,1,-1,0,0,0,0")),
                     "q.plan:4: mission.items: has no item to fly, must have a take-off or a waypoint"}),
    tests::name_of);

TEST(QGroundControlPlan, RequiresAHomeForGeographicItems) {
  std::string text = plan(item(16, 3, "0,0,0,null,47,8,1"));
  const std::size_t begin = text.find("\"plannedHomePosition\"");
  text.erase(begin, text.find("],", begin) + 2 - begin);
  EXPECT_EQ(refusal([&] { qgc(text); }),
            "q.plan:3: mission: has items with geographic coordinates, must have a plannedHomePosition");
}

}  // namespace swiftlet::io::qgroundcontrol_plan_test
