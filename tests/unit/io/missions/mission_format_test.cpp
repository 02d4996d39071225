#include "swiftlet/io/missions/mission_format.hpp"

#include <string>

#include <gtest/gtest.h>

#include "tests/support/paths.hpp"
#include "tests/unit/io/missions/format_support.hpp"

namespace swiftlet::io::mission_format_test {

using Eigen::Vector3d;

MissionFormat detected(const std::string& text, const std::string& file_name) {
  return parse_source(text, file_name).format;
}

TEST(DetectFormat, RecognisesEveryFormat) {
  EXPECT_EQ(detected(kPolynomialHeader + "\n", "a.csv"), MissionFormat::kPolynomialCsv);
  EXPECT_EQ(detected("t,x,y,z\n", "a.csv"), MissionFormat::kSampledCsv);
  EXPECT_EQ(detected("t,x,y,z\n", "a.txt"), MissionFormat::kSampledCsv);
  EXPECT_EQ(detected("t [ms],x_ned [m]\n", "a.csv"), MissionFormat::kSampledCsv);
  EXPECT_EQ(detected("x,y,z\n", "a.csv"), MissionFormat::kWaypointCsv);
  EXPECT_EQ(detected("x_enu [cm],y_enu [cm],z_enu [cm]\n", "a.csv"), MissionFormat::kWaypointCsv);
  EXPECT_EQ(detected("yaw_ned [deg],y_ned [m],x_ned [m],z_ned [m]\n", "a.csv"), MissionFormat::kWaypointCsv);
  EXPECT_EQ(detected("\xef\xbb\xbf"
                     "0.0, 1.5,2e-1\r\n",
                     "a.csv"),
            MissionFormat::kWaypointCsv);
  EXPECT_EQ(detected("0,1,2,0.5\n", "a"), MissionFormat::kWaypointCsv);
  const std::string plan =
      "{\"fileType\": \"Plan\", \"mission\": {\"items\": [{\"type\": \"SimpleItem\", \"command\": 20, "
      "\"params\": [0, 0, 0, 0, 0, 0, 0]}]}}";
  EXPECT_EQ(detected("\n  " + plan, "a.json"), MissionFormat::kQGroundControlPlan);
  EXPECT_EQ(detected(plan, "a.plan"), MissionFormat::kQGroundControlPlan);
  EXPECT_EQ(refusal([] { detected("", "a.plan"); }).rfind("a.plan:1: column 1: the file is empty", 0), 0U);
  EXPECT_EQ(detected("frame: ned\n", "a.yaml"), MissionFormat::kYaml);
  EXPECT_EQ(detected("frame: ned\n", "a"), MissionFormat::kYaml);
}

TEST(DetectFormat, ErrorListsTheKnownCsvHeaders) {
  const std::string known =
      "duration,x^0,... (polynomials), t,x,y,z,... (samples) or x,y,z[,yaw] (waypoints, also without a "
      "header); x may be x_ned [m]";
  EXPECT_EQ(refusal([] { detected("", "a.csv"); }), "a.csv: is empty, must hold " + known);
  EXPECT_EQ(refusal([] { detected("1,2,3,4,5\n", "a.csv"); }),
            "a.csv:1: has no header; 5 columns may be many things: --columns names them in order, such as "
            "--columns t,x,y,z,qx,qy,qz,qw");
  EXPECT_EQ(refusal([] { detected("north,east\n", "a.CSV"); }),
            "a.CSV:1: has 2 fields, of which the first is north; must begin with " + known);
}

TEST(CsvFrame, OfAPathBelowTheGroundIsSuspected) {
  EXPECT_EQ(
      refusal([] { parse_any_mission_file("0,0,-1\n1,0,-1.5\n", "w.csv", control::Limits()); }),
      "w.csv: the whole path is below the ground, at heights of -1.50 to -1.00 m: z is read as up (ENU); "
      "if it points down in this file, the frame is NED: --frame ned");
  EXPECT_EQ(
      refusal([] {
        parse_any_mission_file("t [s],x_ned [m],y_ned [m],z_ned [m]\n0,0,0,1\n1,0,0,1\n", "s.csv",
                               control::Limits());
      }),
      "s.csv: the whole path is below the ground, at heights of -1.00 to -1.00 m: z is read as down (NED); "
      "if it points up in this file, the frame is ENU: --frame enu");
  EXPECT_EQ(refusal([] {
              parse_any_mission_file(kPolynomialHeader + "\n" + polynomial_row(4.0, 0.0, 1.0, -1.0), "p.csv",
                                     control::Limits());
            }).rfind("p.csv: the whole path is below the ground, at heights of -1.00 to -1.00 m", 0),
            0U);
}

TEST(CsvFrame, IsAskedForWhereZCouldPointEitherWay) {
  const control::Limits limits;
  const std::string samples = "t,x,y,z\n0,0,0,0\n1,0,0,0\n4,0,0,-1.4\n5,0,0,-1.4\n";
  const std::string sentence =
      "f.csv: z goes from -1.40 to 0.00 m, and the file names no frame. If z points up, the path is about a "
      "hover and is raised by 2.40 m: --frame enu or nwu. If z points down, its heights are 0.00 to 1.40 m: "
      "--frame ned. A header such as z_enu [m] says it too";
  for (const std::string& text : {samples, std::string("0,0,0\n0,0,-1.4\n"),
                                  kPolynomialHeader + "\n" + polynomial_row(4.0, 0.0, 1.0, 0.0) + "\n" +
                                      polynomial_row(4.0, 1.0, 1.0, -1.4)})
    EXPECT_EQ(refusal([&] { parse_any_mission_file(text, "f.csv", limits); }), sentence) << text;
  const auto start = [&](MissionFrame frame) {
    return at_path_start(parse_any_mission_file(samples, "f.csv", limits, {frame, {}})).position_ned.z();
  };
  EXPECT_NEAR(start(MissionFrame::kNed), -1.0, 1e-3);
  EXPECT_NEAR(start(MissionFrame::kEnu), -2.4, 1e-3);
  const std::string noisy = "t,x,y,z\n0,0,0,-0.02\n1,0,0,-0.02\n4,0,0,1.4\n5,0,0,1.4\n";
  EXPECT_TRUE(assumes(parse_any_mission_file(noisy, "f.csv", limits), "raised by 1.02 m"))
      << "an estimate on the ground";
}

TEST(CsvFrame, IsThatOfTheMessages) {
  const control::Limits limits;
  EXPECT_EQ(refusal([&] { parse_any_mission_file("0,0,1\n0,0,9\n", "w.csv", limits); }),
            "w.csv:2: x,y,z: in ENU: z is 9.000 m, outside the fence of 0.000 to 2.500 m");
  EXPECT_EQ(refusal([&] {
              parse_any_mission_file("x_nwu [m],y_nwu [m],z_nwu [m]\n0,0,1\n0,-4,1\n", "w.csv", limits);
            }),
            "w.csv:3: x,y,z: in NWU: y is -4.000 m, outside the fence of -3.000 to 3.000 m");
}

TEST(LoadTrajectoryFile, AddsNeitherTakeOffNorLanding) {
  const TrajectoryFile path = load_trajectory_file(kData + "uav_waypoints.csv", control::Limits());
  EXPECT_EQ(path.segments.size(), 17U);
  for (const std::string& assumption : path.assumptions)
    EXPECT_EQ(assumption.find("take-off"), std::string::npos) << assumption;
  EXPECT_EQ(refusal([] {
              load_trajectory_file(tests::in_source("config/missions/square.yaml"), control::Limits());
            }),
            tests::in_source("config/missions/square.yaml") +
                ": must hold exactly one trajectory; `swiftlet fly` flies missions");
}

TEST(CsvFrame, OfAFileThatNamesNoneIsThatOfTheOption) {
  const control::Limits limits;
  const FileOptions ned = {MissionFrame::kNed, {}};
  EXPECT_LT((at_path_start(parse_any_mission_file("t,x,y,z\n0,1,2,-1\n4,1,2,-1\n", "s.csv", limits, ned))
                 .position_ned -
             Vector3d(1, 2, -1))
                .norm(),
            1e-9);
  EXPECT_EQ(at_path_start(parse_any_mission_file("1,2,-1\n1,1,-1\n", "w.csv", limits, ned)).position_ned,
            Vector3d(1, 2, -1));
  EXPECT_EQ(
      at_path_start(parse_any_mission_file("x_ned [cm],y_ned [cm],z_ned [cm]\n100,200,-100\n100,100,-100\n",
                                           "w.csv", limits))
          .position_ned,
      Vector3d(1, 2, -1));
  EXPECT_LT(
      (at_path_start(parse_any_mission_file(kPolynomialHeader + "\n" + polynomial_row(4.0, 0.5, 1.0, -1.5),
                                            "p.csv", limits, ned))
           .position_ned -
       Vector3d(0.5, 0, -1.5))
          .norm(),
      1e-9);
}

}  // namespace swiftlet::io::mission_format_test
