// Tables in the forms of other projects.
#include "swiftlet/io/missions/mission_table.hpp"

#include <cmath>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/io/missions/format_support.hpp"

namespace swiftlet::io::mission_table_test {

using Eigen::Vector3d;

class MissionTableTest : public testing::Test {
 protected:
  MissionFile load(const std::string& name, const std::string& text, const FileOptions& options = {}) const {
    return load_mission_file(folder_.write(name, text), field(), options);
  }
  std::string refused(const std::string& text, const FileOptions& options = {}) const {
    const std::string sentence = refusal([&] { load("f.csv", text, options); });
    return sentence.rfind(folder_.path().string(), 0) == 0
               ? sentence.substr(folder_.path().string().size() + 1)
               : sentence;
  }

  tests::TemporaryFolder folder_;
};

std::string upper_header() {
  std::string header = kPolynomialHeader;
  header[0] = 'D';
  return header;
}

// Rests at (0.1, 0.2, 1.5) in ENU, which turns to face north: rows of `row` with the stamp in place of {}.
std::string rows(const std::string& row, double step = 0.1, int decimals = 1) {
  std::string text;
  for (int i = 0; i < 30; ++i)
    text += fmt::format(fmt::runtime(row), fmt::format("{:.{}f}", step * i, decimals)) + "\n";
  return text;
}

void expect_still(const MissionFile& file, double yaw_ned) {
  EXPECT_LT((at_path_start(file).position_ned - Vector3d(0.2, 0.1, -1.5)).norm(), 1e-9);
  EXPECT_NEAR(at_path_start(file).yaw_rad, yaw_ned, 2e-3);
  double duration_s = 0.0;
  for (const control::PolynomialSegment& segment : file.mission.segments) duration_s += segment.duration_s;
  EXPECT_NEAR(duration_s, 2.9, 1e-6);
}

TEST_F(MissionTableTest, PolynomialsOfUavTrajectories) {
  const std::string row = polynomial_row(4.0, 0.0, 1.0, 1.0);
  for (const std::string& header : {upper_header(), "# " + kPolynomialHeader, "#" + upper_header()}) {
    const MissionFile file = load("p.csv", "# made by genTrajectory\n\n" + header + "\n" + row + ",\n\n" +
                                               polynomial_row(4.0, 1.0, -1.0, 1.0) + "\n# end\n");
    EXPECT_EQ(file.mission.segments.size(), 2U) << header;
  }
  EXPECT_EQ(refused(upper_header() + "\n\n# fast\n" + polynomial_row(0.1, 0.0, 5.0, 1.0) + "\n")
                .rfind("f.csv:4: segment 1 in ENU reaches ", 0),
            0U)
      << "the line of the file";
}

TEST_F(MissionTableTest, Agilicious) {
  const MissionFile file =
      load("a.csv",
           "t,p_x,p_y,p_z,q_w,q_x,q_y,q_z,v_x,v_y,v_z,w_x,w_y,w_z,a_lin_x,a_lin_y,a_lin_z,a_rot_x,a_rot_y,"
           "a_rot_z,u_1,u_2,u_3,u_4,jerk_x,jerk_y,jerk_z,snap_x,snap_y,snap_z\n" +
               rows("{},0.1,0.2,1.5,0.707107,0,0,0.707107,0,0,0,0,0,0,0,0,0,0,0,0,1,1,1,1,0,0,0,0,0,0"));
  expect_still(file, 0.0);
  EXPECT_TRUE(
      assumes(file, "are read as t, x, y, z, vx, vy, vz, ax, ay, az, yaw, the yaw from the quaternion"));
  EXPECT_TRUE(assumes(file, "not used: w_x, w_y, w_z, a_rot_x"));
}

TEST_F(MissionTableTest, EuRoC) {
  std::string text =
      "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z [], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1]\n";
  for (std::int64_t i = 0; i < 30; ++i)
    text += std::to_string(1403636580838555648 + i * 100000000) +
            ",0.1,0.2,1.5,0.707107,0.0,0.0,0.707107,0.0,0.0,0.0,-0.002153\n";
  const MissionFile file = load("e.csv", text);
  expect_still(file, 0.0);
  EXPECT_TRUE(assumes(file, "30 samples at 10 Hz became "));
  text.replace(text.find("#timestamp [ns]"), 15, "#timestamp");
  EXPECT_TRUE(assumes(load("e.csv", text), "stamps are taken as ns"));
}

TEST_F(MissionTableTest, Tum) {
  const std::string list = rows("{} 0.1 0.2 1.5 0 0 0.707107 0.707107");
  expect_still(load("t.txt", list), 0.0);
  expect_still(load("t.txt", "# ground truth trajectory\n# timestamp tx ty tz qx qy qz qw\n" + list), 0.0);
  EXPECT_TRUE(assumes(load("t.txt", list), "its columns are taken as t, x, y, z, qx, qy, qz, qw"));
  EXPECT_EQ(refused(rows("{} 0.1 0.2 1.5 0 0 0.9 0.9")),
            "f.csv:1: qw, qx, qy, qz are a quaternion of length 1.273, must be 1");
}

TEST_F(MissionTableTest, SeparatorsCommentsAndNames) {
  const std::string row = "{};0.1;0.2;1.5;1.5708";
  expect_still(load("s.csv", "time;pos_x;pos_y;pos_z;heading\n" + rows(row)), 0.0);
  expect_still(load("s.csv", "// exported\nTime\tpx\tpy\tpz\tyaw\n" + rows("{}\t0.1\t0.2\t1.5\t1.5708")),
               0.0);
  expect_still(load("s.csv", "t,x,y,z,yaw\n\n% at rest\n" + rows("{},0.1,0.2,1.5,1.5708")), 0.0);
  EXPECT_EQ(refused("t;x;y;z\n0;0,1;0;1.5\n"),
            "f.csv:2: has commas beside semicolons: numbers must have points");
  EXPECT_EQ(refused("t,x,y,z,colour\n0,0,0,1,3\n")
                .rfind("f.csv:1: header: has the column colour, which is not known", 0),
            0U);
  EXPECT_TRUE(assumes(load("s.csv", "# x y z\n0 0 1\n1 0 1\n0 1 1\n"), "flown without stopping"));
}

TEST_F(MissionTableTest, AsksWhatCouldBeTwoThings) {
  const std::string timed = rows("{},0.1,0.2,1.5");
  EXPECT_EQ(refused(timed),
            "f.csv:1: has no header; its first column rises in equal steps: t,x,y,z or waypoints x,y,z,yaw? "
            "--columns "
            "t,x,y,z or --columns x,y,z,yaw says which");
  EXPECT_EQ(refused(rows("0.1,0.2,1.5,{}")),
            "f.csv:1: has no header; its last column rises in equal steps: x,y,z,t or waypoints x,y,z,yaw? "
            "--columns "
            "x,y,z,t or --columns x,y,z,yaw says which");
  FileOptions options;
  options.frame = MissionFrame::kEnu;
  options.columns = "t,x,y,z";
  EXPECT_TRUE(assumes(load("f.csv", timed, options), "30 samples at 10 Hz"));
  options.columns = "t,x,y";
  EXPECT_EQ(refused(timed, options), "f.csv:1: has 4 columns, --columns names 3");
  EXPECT_EQ(
      refused("1,2,3,4,5\n1,2,3,4,5\n").rfind("f.csv:1: has no header; 5 columns may be many things", 0), 0U);
  const MissionFile points = load("f.csv", "0,0,1,0.5\n1,0,1,0.1\n0,1,1,0.2\n");
  EXPECT_TRUE(assumes(points, "the file has no header: its columns are taken as x, y, z, yaw"));
}

TEST_F(MissionTableTest, AsksWhetherALargeYawIsInDegrees) {
  const std::string text = rows("{},0.1,0.2,1.5,90");
  EXPECT_EQ(refused("t,x,y,z,yaw\n" + text)
                .rfind("f.csv:2: yaw: is 90, more than a full turn in rad: degrees, or several turns?", 0),
            0U);
  FileOptions options;
  options.frame = MissionFrame::kEnu;
  options.columns = "t [s],x,y,z,yaw [deg]";
  expect_still(load("f.csv", "t,x,y,z,yaw\n" + text, options), 0.0);
}

TEST_F(MissionTableTest, KeepsTheUnitsOfAHeader) {
  const std::string show =
      "Time [msec],x [m],y [m],z [m],Red,Green,Blue\n" + rows("{},0.1,0.2,1.5,255,0,40", 100.0, 0);
  MissionFile file = load("show.csv", show);
  expect_still(file, 0.0);
  EXPECT_TRUE(assumes(file, "not used: Red, Green, Blue"));
  FileOptions options;
  options.frame = MissionFrame::kEnu;
  options.columns = "t,x,y,z,w_,w_,w_";
  expect_still(load("show.csv", show, options), 0.0);
  options.columns = "t,x [cm],y,z,w_,w_,w_";
  EXPECT_NEAR(at_path_start(load("show.csv", show, options)).position_ned.y(), 0.001, 1e-9)
      << "the option names another unit";
  options.columns = "x,t,y,z,w_,w_,w_";
  EXPECT_EQ(refused(show, options),
            "f.csv:1: header: has the column Time [msec], which --columns names x: that has no unit msec");
  options.columns = "t,x,y,z_ned";
  EXPECT_EQ(refused("t [ms],x [cm],y [cm],z_enu [cm]\n" + rows("{},10,20,150", 100.0, 0), options),
            "f.csv:1: header: has the column z_enu [cm], which --columns names z_ned: which frame is it?");
  const std::string fractions = "time [ms],pos_x,pos_y,pos_z,heading\n";
  expect_still(load("ms.csv", fractions + rows("{},0.1,0.2,1.5,1.5708", 100.0, 3)), 0.0);
  EXPECT_EQ(refused("time [ms],pos_x [cm],pos_y [cm],pos_z [cm]\n" + rows("{},10,20,150", 100.0, 0))
                .rfind("f.csv:1: header: names no frame: ", 0),
            0U);
}

TEST_F(MissionTableTest, RefusesUnitsThatAreNotKnown) {
  EXPECT_EQ(refused("Time [min],pos_x [m],pos_y [m],pos_z [m]\n" + rows("{},0.1,0.2,1.5", 1.0, 0))
                .rfind("f.csv:1: header: has the column t [min] with an unknown unit, must be ", 0),
            0U);
}

TEST_F(MissionTableTest, ListOfWaypoints) {
  const std::string list =
      "QGC WPL 110\n"
      "0\t1\t0\t16\t0\t0\t0\t0\t47.3977419\t8.5455938\t488.0\t1\n"
      "1\t0\t3\t22\t0\t0\t0\t0\t47.3977419\t8.5455938\t2.0\t1\n"
      "2\t0\t3\t16\t0\t0\t0\t0\t47.3978319\t8.5455938\t2.0\t1\n"
      "3\t0\t3\t21\t0\t0\t0\t0\t47.3978319\t8.5455938\t0.0\t1\n";
  const MissionFile file = load("mission.waypoints", list);
  ASSERT_EQ(file.mission.items.size(), 3U);
  EXPECT_TRUE(file.takes_off());
  EXPECT_TRUE(file.lands());
  EXPECT_NEAR(file.mission.items[1].position_ned.x(), 10.0, 0.05);
  EXPECT_NEAR(file.mission.items[1].position_ned.z(), -2.0, 1e-9);
  EXPECT_TRUE(assumes(file, "a list of waypoints"));
  std::string home_in_frame_3 = list;
  home_in_frame_3.replace(home_in_frame_3.find("0\t1\t0\t16"), 8, "0\t1\t3\t16");
  EXPECT_EQ(load("h.waypoints", home_in_frame_3).mission.items[1].position_ned,
            file.mission.items[1].position_ned);
  std::string broken = list;
  broken.replace(broken.find("8.5455938\t2.0\t1\n2"), 9, "east");
  EXPECT_NE(
      refusal([&] { load("m.txt", broken); }).find("m.txt:3: field 10: is east, must be a finite number"),
      std::string::npos);
}

}  // namespace swiftlet::io::mission_table_test
