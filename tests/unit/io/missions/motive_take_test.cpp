// Takes of Motive, as versions 2 and 3 export them.
#include "swiftlet/io/missions/motive_take.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "swiftlet/io/missions/mission_file.hpp"
#include "tests/unit/io/missions/format_support.hpp"

namespace swiftlet::io::motive_take_test {

constexpr const char* kAbout =
    "Format Version,1.23,Take Name,Take 2024-05-06 11.20.33 AM,Capture Frame Rate,120.000000,Rotation "
    "Type,Quaternion,Length Units,Meters,Coordinate Space,Global\n\n";

// A body with a marker. The body turns by 30 degrees to the right: about the axis that points up, -0.2588 Y.
const std::string kTake =
    std::string(kAbout) +
    ",,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body "
    "Marker,Rigid Body Marker,Rigid Body Marker\n"
    ",,cf1,cf1,cf1,cf1,cf1,cf1,cf1,cf1,cf1:Marker1,cf1:Marker1,cf1:Marker1\n"
    ",,\"0CF0\",\"0CF0\",\"0CF0\",\"0CF0\",\"0CF0\",\"0CF0\",\"0CF0\",\"0CF0\",\"11\",\"11\",\"11\"\n"
    ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Mean Marker "
    "Error,Position,Position,Position\n"
    "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,,X,Y,Z\n"
    "0,0.000000,0,-0.258819,0,0.965926,0.100000,1.500000,-0.200000,0.0001,9,9,9\n"
    "1,0.008333,,,,,,,,,,,\n"
    "2,0.016667,0,0,0,1,0.101000,-0.500000,-0.300000,0.0001,9,9,9\n";

TEST(MotiveTake, IsReadAsPosesOfItsBody) {
  ASSERT_TRUE(is_motive_take(kTake));
  const MissionTable take = read_motive_take(kTake, "take.csv", {});
  EXPECT_EQ(take.table.columns(),
            (std::vector<std::string>{"t [s]", "x_ned [m]", "y_ned [m]", "z_ned [m]", "yaw_ned [rad]"}));
  ASSERT_EQ(take.table.row_count(), 2U) << "the body is not seen in one frame";
  const std::vector<double> first = take.table.row(0);
  EXPECT_EQ((std::vector<double>{first.begin(), first.begin() + 4}),
            (std::vector<double>{0.0, 0.1, -0.2, -1.5}));
  EXPECT_NEAR(first[4], M_PI / 6, 1e-5);
  EXPECT_EQ(take.table.row(1), (std::vector<double>{0.016667, 0.101, -0.3, 0.5, 0.0}));
  EXPECT_EQ(take.table.line(1), 10);
  EXPECT_EQ(
      take.assumptions.front(),
      "a take of Motive: the rigid body cf1, in 2 of 3 frames; Y is up, x north and z east, unless --frame "
      "nwu says that Z is up and x north");
}

TEST(MotiveTake, HasItsAxesByFrameAndItsUnit) {
  std::string take = kTake;
  take.replace(take.find("Meters"), 6, "Millimeters");
  const MissionTable read = read_motive_take(take, "take.csv", MissionFrame::kNwu);
  EXPECT_EQ(read.table.column(2), "y [mm]");
  EXPECT_EQ(read.table.row(1), (std::vector<double>{0.016667, 0.101, -0.5, -0.3, 0.0}));
}

// Motive 3 names its lines, and may have skeletons and markers first.
TEST(MotiveTake, OfMotive3IsFlown) {
  std::string take =
      std::string(kAbout) +
      ",Type,Marker,Marker,Marker,Rigid Body,Rigid Body,Rigid Body\n"
      ",Name,Unlabeled 1,Unlabeled 1,Unlabeled 1,cf 2,cf 2,cf 2\n"
      ",ID,1,1,1,2,2,2\n,Parent,,,,,,\n,,Position,Position,Position,Position,Position,Position\n"
      "Frame,Time (Seconds),X,Y,Z,X,Y,Z\n";
  for (int i = 0; i <= 240; ++i) {  // 0.6 m north in 2 s
    const double s = i / 240.0;
    const double x = 0.6 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
    take += fmt::format("{},{:.6f},7,7,7,{:.6f},1.200000,0.000000\n", i, i / 120.0, x);
  }
  const MissionFile file = parse_any_mission_file(take, "take.csv", field());
  EXPECT_TRUE(assumes(file, "the rigid body cf 2, in 241 of 241 frames")) << "its yaw is not exported";
  const control::Reference begin = at_path_start(file);
  EXPECT_NEAR(begin.position_ned.z(), -1.2, 1e-6);
  const control::PolynomialSegment& last = file.mission.segments.back();
  EXPECT_NEAR(control::evaluate(last, last.duration_s).position_ned.x(), 0.6, 1e-3);
}

TEST(MotiveTake, IsRefusedIfItIsNoPathOfOneBody) {
  const auto refused = [](const std::string& text) {
    return refusal([&] { read_motive_take(text, "take.csv", {}); });
  };
  const std::string places =
      ",,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body\n,,a,a,a,b,b,b\n";
  EXPECT_EQ(refused(kAbout + places +
                    ",,Position,Position,Position,Position,Position,Position\nFrame,Time,X,Y,Z,X,Y,Z\n"),
            "take.csv: has the rigid bodies a, b: export one of them");
  EXPECT_EQ(refused(kAbout), "take.csv: is a take of Motive without a line Frame,Time (Seconds),...");
  EXPECT_EQ(refused(std::string(kAbout) + ",,Marker\n,,Position\nFrame,Time (Seconds),X\n"),
            "take.csv: is a take of Motive without a rigid body that has positions");
  std::string local = kTake;
  local.replace(local.find("Global"), 6, "Local");
  EXPECT_EQ(refused(local), "take.csv: has local coordinates: export it with those of Global");
  std::string spoiled = kTake;
  spoiled.replace(spoiled.find("0.101000"), 8, "NaN");
  EXPECT_NE(refused(spoiled).find("take.csv:10: X: is NaN"), std::string::npos) << refused(spoiled);
  FileOptions options;
  options.columns = "t,x,y,z";
  EXPECT_NE(refusal([&] { parse_source(kTake, "take.csv", options); }).find("names its columns itself"),
            std::string::npos);
}

}  // namespace swiftlet::io::motive_take_test
