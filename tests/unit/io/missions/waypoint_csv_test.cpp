#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "tests/unit/fault.hpp"
#include "tests/unit/io/missions/format_support.hpp"

namespace swiftlet::io::waypoint_csv_test {

using Eigen::Vector3d;

MissionFile waypoints(const std::string& text) {
  return parse_any_mission_file(text, "w.csv", control::Limits());
}

TEST(WaypointCsv, PassesWaypointsWithoutStopping) {
  const MissionFile with_header = waypoints("x,y,z,yaw\n0,0,1,1.57\n1,0,1,1.57\n1,1,1.5,0\n");
  const MissionFile without = waypoints("0,0,1,1.57\n1,0,1,1.57\n1,1,1.5,0");
  ASSERT_EQ(with_header.mission.segments.size(), 2U);
  ASSERT_EQ(without.mission.segments.size(), 2U);
  EXPECT_EQ(with_header.mission.segments[1].x, without.mission.segments[1].x);
  const control::Reference middle = control::evaluate(without.mission.segments[1], 0.0);
  EXPECT_LT((middle.position_ned - Vector3d(0, 1, -1)).norm(), 1e-9);
  EXPECT_GT(middle.velocity_ned.norm(), 0.1);
  EXPECT_NEAR(middle.yaw_rad, M_PI / 2 - 1.57, 1e-9);
  EXPECT_TRUE(control::check(without.mission, control::Limits()).accepted);
}

TEST(WaypointCsv, ReadsAUavTrajectoriesFile) {
  const MissionFile file = load_mission_file(kData + "uav_waypoints.csv", control::Limits());
  EXPECT_EQ(file.mission.segments.size(), 17U);
  EXPECT_LT((at_path_start(file).position_ned - Vector3d(0.453548997641, 0, -1.4156037569)).norm(), 1e-12);
  EXPECT_TRUE(assumes(file, "above the ground: the lowest point is 1.39 m"));
  EXPECT_TRUE(control::check(file.mission, control::Limits()).accepted);
}

class BadWaypointCsv : public testing::TestWithParam<tests::Fault> {};
TEST_P(BadWaypointCsv, IsRefusedWithASentence) {
  EXPECT_EQ(refusal([] { waypoints(GetParam().text); }), GetParam().sentence);
}
std::string hover_points(int rows) {
  std::string text;
  for (int i = 0; i < rows; ++i) text += std::to_string(0.1 * (i % 10)) + ",0,1\n";
  return text;
}
INSTANTIATE_TEST_SUITE_P(
    , BadWaypointCsv,
    testing::Values(
        tests::Fault{"one_point", "0,0,1\n", "w.csv: has 1 rows, must have at least 2"},
        tests::Fault{"missing_field", "0,0,1\n1,0\n", "w.csv:2: has 2 fields, must have 3: x,y,z"},
        tests::Fault{"infinite", "0,0,1\n1,inf,1\n", "w.csv:2: y: is inf, must be a finite number"},
        tests::Fault{"degrees", "0,0,1,0\n1,0,1,90\n",
                     "w.csv:2: yaw: waypoint 2: yaw is 90 rad, more than a full turn: 90 degrees are 1.5708 "
                     "rad, 90 rad are the yaw 2.0354 rad"},
        tests::Fault{"outside_the_fence", "0,0,1\n3.1,0,1\n",
                     "w.csv:2: x,y,z: in ENU: x is 3.100 m, outside the fence of -3.000 to 3.000 m"},
        tests::Fault{"equal_points", "0,0,1\n0,0,1\n",
                     "w.csv: the path has no length: all points are at one place"},
        tests::Fault{"too_many_points", hover_points(1026),
                     "w.csv:1026: x,y,z: is waypoint 1026, at most 1025 fit"}),
    tests::name_of);

TEST(WaypointCsv, NamesTheWaypointBeforeAFenceViolation) {
  const std::string sentence = refusal([] { waypoints("0,0,1\n3,0,1\n3,2.9,1\n0,0,1\n"); });
  EXPECT_EQ(sentence.find("w.csv:2: the path from here: segment 2 in ENU: x is "), 0U) << sentence;
  EXPECT_NE(sentence.find("outside the fence of -3.000 to 3.000 m"), std::string::npos) << sentence;
}

TEST(WaypointCsv, AcceptsTheMaximumOfPoints) {
  EXPECT_EQ(waypoints(hover_points(1025)).mission.segments.size(), 1024U);
}

}  // namespace swiftlet::io::waypoint_csv_test
