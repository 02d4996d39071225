// Samples in the columns of a CSV file, and flight records.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "tests/unit/fault.hpp"
#include "tests/unit/io/missions/format_support.hpp"

namespace swiftlet::io::sampled_csv_test {

using Eigen::Vector3d;

MissionFile samples(const std::string& text) {
  return parse_any_mission_file(text, "s.csv", control::Limits());
}

// Minimum jerk from (0, 0, 1) by 1 m east in 4 s, at a rate.
std::string sampled(double rate_hz, const std::string& columns, bool yaw = false) {
  const control::PolynomialSegment s = control::minimum_jerk({0, 0, 1}, 0, {1, 0, 1}, 0, 4.0);
  std::string text = columns + "\n";
  const int rows = static_cast<int>(4.0 * rate_hz);
  const auto add = [&](const Vector3d& v) {
    for (int i = 0; i < 3; ++i) text += "," + std::to_string(v[i]);
  };
  for (int i = 0; i <= rows; ++i) {
    const control::Reference r = control::evaluate(s, i / rate_hz);
    text += std::to_string(i / rate_hz);
    add(r.position_ned);  // the file is read as ENU
    if (columns.find("vx") != std::string::npos) add(r.velocity_ned);
    if (columns.find("ax") != std::string::npos) add(r.acceleration_ned);
    if (yaw)
      text += "," + std::to_string(3.0 + 0.5 * i / rate_hz > M_PI ? 3.0 + 0.5 * i / rate_hz - 2 * M_PI
                                                                  : 3.0 + 0.5 * i / rate_hz);
    text += "\n";
  }
  return text;
}

double furthest_from_truth(const MissionFile& file) {
  const control::PolynomialSegment s = control::minimum_jerk({0, 0, -1}, 0, {0, 1, -1}, 0, 4.0);
  double furthest = 0.0;
  double start_s = 0.0;
  for (const control::PolynomialSegment& segment : file.mission.segments) {
    for (int i = 0; i <= 10; ++i) {
      const double t = segment.duration_s * i / 10;
      furthest = std::max(furthest, (control::evaluate(segment, t).position_ned -
                                     control::evaluate(s, start_s + t).position_ned)
                                        .norm());
    }
    start_s += segment.duration_s;
  }
  EXPECT_NEAR(start_s, 4.0, 1e-9);
  return furthest;
}

TEST(SampledCsv, InterpolatesBetweenSamples) {
  EXPECT_LT(furthest_from_truth(samples(sampled(10.0, "t,x,y,z"))), 1e-4);
  EXPECT_LT(furthest_from_truth(samples(sampled(10.0, "t,x,y,z,vx,vy,vz"))), 1e-3);
  EXPECT_LT(furthest_from_truth(samples(sampled(10.0, "t,x,y,z,vx,vy,vz,ax,ay,az"))), 1e-5);
  const MissionFile file = samples(sampled(10.0, "t,x,y,z"));
  EXPECT_TRUE(assumes(file, "41 samples at 10 Hz became 10 segments; largest deviation "));
  EXPECT_TRUE(assumes(file, "the path is made of the columns t, x, y, z"));
  EXPECT_TRUE(assumes(file, "no yaw"));
}

TEST(SampledCsv, NeedsFewSegmentsAndComparesTheDerivatives) {
  const MissionFile file = samples(sampled(1000.0, "t,x,y,z,vx,vy,vz,ax,ay,az"));
  EXPECT_LE(file.mission.segments.size(), 20U);
  EXPECT_LT(furthest_from_truth(file), 1e-6);
  EXPECT_TRUE(assumes(file, "4001 samples at 1000 Hz became "));
  EXPECT_TRUE(assumes(file, "; largest deviation 0."));
  EXPECT_TRUE(assumes(file, "the path is made of the columns t, x, y, z"));
  EXPECT_TRUE(assumes(file, "its velocity differs from vx, vy, vz by up to "));
}

// The columns of a still vehicle whose stamps are as given, of which the first is 0.
std::string still(const std::vector<std::string>& stamps) {
  std::string text = "t,x,y,z\n";
  for (const std::string& stamp : stamps) text += stamp + ",0.1,0.2,1.000\n";
  return text;
}

TEST(SampledCsv, UndoesTheRoundingOfStamps) {
  std::vector<std::string> stamps;
  for (int i = 0; i <= 90; ++i) stamps.push_back(io::exact(std::round(i / 30.0 * 1e3) / 1e3));
  EXPECT_TRUE(assumes(samples(still(stamps)), "91 samples at 30 Hz"));
  EXPECT_TRUE(assumes(samples(still(stamps)), "stamps are rounded by up to 0.00033 s: even steps are used"));
}

TEST(SampledCsv, TellsGapsAndJitterByTheirLines) {
  std::vector<std::string> stamps;
  for (int i = 0; i <= 50; ++i) {
    if (i < 20 || i > 30) stamps.push_back(io::exact(0.01 * i + (i == 40 ? 0.004 : 0.0)));
  }
  const MissionFile file = samples(still(stamps));
  EXPECT_TRUE(assumes(file, "line 22: no samples for 0.12 s before it, the usual step is 0.01 s"));
  EXPECT_TRUE(assumes(file, "stamps are uneven: steps of 0.006 s (line 32) to 0.014 s (line 31)"));
}

TEST(SampledCsv, PassesSamplesByAsFarAsItMay) {
  std::string text = "t,x,y,z\n";
  for (int i = 0; i <= 400; ++i)  // 2 mm of noise
    text += io::exact(0.01 * i) + "," + io::exact(i % 2 == 0 ? 0.001 : -0.001) + ",0,1.000000\n";
  const auto strongest_with = [&](std::optional<double> tolerance_m) {
    double strongest = 0.0;
    control::Limits limits;
    limits.max_acceleration = 1e9;
    for (const auto& s : parse_any_mission_file(text, "s.csv", limits, {{}, tolerance_m}).mission.segments)
      strongest = std::max(strongest, control::evaluate(s, 0.0).acceleration_ned.norm());
    return strongest;
  };
  EXPECT_LT(strongest_with(0.0011), 1.0);
  EXPECT_GT(strongest_with(1e-5), 5.0);
  EXPECT_EQ(refusal([] {
              load_trajectory_file(kData + "uav_waypoints.csv", control::Limits(), {{}, 0.01});
            }),
            kData + "uav_waypoints.csv: is no table of samples: --tolerance is for those");
}

TEST(SampledCsv, UnwrapsYaw) {
  const MissionFile file = samples(sampled(10.0, "t,x,y,z,yaw", true));
  double before = at_path_start(file).yaw_rad;
  EXPECT_NEAR(before, M_PI / 2 - 3.0, 1e-6);
  for (const control::PolynomialSegment& segment : file.mission.segments) {
    EXPECT_NEAR(segment.yaw[0], before, 0.1);
    before = control::evaluate(segment, segment.duration_s).yaw_rad;
  }
  EXPECT_NEAR(before, M_PI / 2 - 5.0, 1e-3);
}

TEST(SampledCsv, ReadsWhatAStreamOfPositionsHas) {
  const std::string rows = "0,10,20,-100\n1000,10,20,-100\n2000,10,20,-100\n";
  const auto at_start = [&](const std::string& header, std::optional<MissionFrame> frame) {
    return at_path_start(
        parse_any_mission_file(header + "\n" + rows, "s.csv", control::Limits(), {frame, {}}));
  };
  const Vector3d there(0.1, 0.2, -1.0);
  EXPECT_LT((at_start("t [ms],x_ned [cm],y_ned [cm],z_ned [cm]", {}).position_ned - there).norm(), 1e-9);
  EXPECT_LT((at_start("t [ms],x [cm],y [cm],z [cm]", MissionFrame::kNed).position_ned - there).norm(), 1e-9);
  EXPECT_EQ(refusal([&] { at_start("t [ms],x_ned [cm],y_ned [cm],z_ned [cm]", MissionFrame::kEnu); }),
            "s.csv:1: header: names the frame ned, but --frame names enu");
  const MissionFile file = samples(
      "z_enu [m],t [s],y_enu [m],x_enu [m],yaw_enu [deg],yaw_rate_enu [deg/s],ax_enu [m/s^2],"
      "ay_enu [m/s^2],az_enu [m/s^2]\n1,0,0.2,0.1,90,0,0,0,0\n1,1,0.2,0.1,90,0,0,0,0\n");
  EXPECT_LT((at_path_start(file).position_ned - Vector3d(0.2, 0.1, -1.0)).norm(), 1e-9);
  EXPECT_NEAR(at_path_start(file).yaw_rad, 0.0, 1e-9);
  EXPECT_FALSE(assumes(file, "taken as")) << "the header says all";
  EXPECT_TRUE(assumes(file, "the path is made of the columns z, t, y, x, yaw, ax, ay, az"));
  EXPECT_TRUE(assumes(file, "yaw_rate is not used"));
}

// A vertical take-off to 1 m, `moves` m north in 2 s and back, and a landing, at 100 Hz; 20 ms on the ground
// have no reference.
std::string flight_table(const std::string& header, bool older) {
  std::string text = header + "\n0,,0,\n0.01,,0,\n";
  double begin_s = 0.02;
  const auto fly = [&](const Vector3d& from, const Vector3d& to, double duration_s) {
    const control::PolynomialSegment s = control::minimum_jerk(from, 0.3, to, 0.3, duration_s);
    for (int i = 0; i < std::lround(duration_s * 100); ++i) {
      const control::Reference r = control::evaluate(s, i * 0.01);
      text += io::exact(begin_s + i * 0.01) + (older ? ",4,0" : ",mission,0");
      const auto add = [&](const Vector3d& v) {
        for (int axis = 0; axis < 3; ++axis) text += "," + io::exact(v[axis]);
      };
      add(r.position_ned);
      add(r.velocity_ned);
      if (!older) add(r.acceleration_ned);
      text += ",0.3\n";
    }
    begin_s += duration_s;
  };
  fly({0, 0, 0}, {0, 0, -1}, 3.0);
  fly({0, 0, -1}, {1, 0, -1}, 4.0);
  fly({1, 0, -1}, {0, 0, -1}, 4.0);
  fly({0, 0, -1}, {0, 0, 0}, 4.0);
  const std::size_t fields = static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')) + 1;
  for (const char* const row : {"\n0,,0,\n", "\n0.01,,0,\n"})
    text.replace(text.find(row), std::string(row).size(),
                 std::string(row, std::string(row).size() - 1) + std::string(fields - 4, ',') + "\n");
  return text;
}

const std::string kFlight =
    "t [s],mode,x_ned [m],ref_x_ned [m],ref_y_ned [m],ref_z_ned [m],ref_vx_ned [m/s],ref_vy_ned [m/s],"
    "ref_vz_ned [m/s],ref_ax_ned [m/s^2],ref_ay_ned [m/s^2],ref_az_ned [m/s^2],ref_yaw_ned [rad]";
const std::string kOlderFlight = "t,mode,px,ref_px,ref_py,ref_pz,ref_vx,ref_vy,ref_vz,ref_yaw";

TEST(FlightTable, IsFlownAgainBetweenTakeOffAndLanding) {
  for (const bool older : {false, true}) {
    const MissionFile file = samples(flight_table(older ? kOlderFlight : kFlight, older));
    EXPECT_TRUE(assumes(file, "the reference of a recorded flight between take-off and landing, t = 3.0"))
        << file.assumptions.front();
    EXPECT_TRUE(control::check(file.mission, control::Limits()).accepted);
    EXPECT_LT((at_path_start(file).position_ned - Vector3d(0, 0, -1)).norm(), 1e-3);
    EXPECT_NEAR(at_path_start(file).yaw_rad, 0.3, 1e-9);
    double farthest = 0.0;
    for (const control::PolynomialSegment& s : file.mission.segments)
      farthest = std::max(farthest, control::evaluate(s, s.duration_s).position_ned.x());
    EXPECT_NEAR(farthest, 1.0, 1e-3);
  }
}

TEST(FlightTable, IsRefusedWithoutAFlight) {
  EXPECT_EQ(
      refusal([] { samples(kFlight + "\n"); }),
      "s.csv: has no reference between a take-off and a landing: it is never at rest at least 0.2 m above "
      "the ground");
  EXPECT_EQ(refusal([] { samples("t,mode,ref_px\n0,4,1\n"); }),
            "s.csv:1: header: has no column ref_py, which the table of a flight has");
}

class BadSampledCsv : public testing::TestWithParam<tests::Fault> {};
TEST_P(BadSampledCsv, IsRefusedWithASentence) {
  EXPECT_EQ(refusal([] { samples(GetParam().text); }), GetParam().sentence);
}
INSTANTIATE_TEST_SUITE_P(
    , BadSampledCsv,
    testing::Values(
        tests::Fault{"one_row", "t,x,y,z\n0,0,0,1\n",
                     "s.csv: has 1 rows behind the header, must have at least 2"},
        tests::Fault{"time_repeats", "t,x,y,z\n0,0,0,1\n1,0,0,1\n1,0,0,1\n",
                     "s.csv:4: t: is 1 again, stamps must rise from row to row"},
        tests::Fault{"time_decreases", "t,x,y,z\n5,0,0,1\n4,0,0,1\n",
                     "s.csv:3: t: is 4, must be at least 5.0001 and at most 3605 s"},
        tests::Fault{"nan", "t,x,y,z\n0,0,0,1\n1,0,nan,1\n", "s.csv:3: y: is nan, must be a finite number"},
        tests::Fault{"part_of_a_velocity", "t,x,y,z,vx\n0,0,0,1,0\n",
                     "s.csv:1: header: has no column vy [m/s], must have vx [m/s], vy [m/s] and vz [m/s]"},
        tests::Fault{"unused_column", "t,x,y,z,roll\n0,0,0,1,0\n",
                     "s.csv:1: header: has the column roll [rad], which a trajectory does not use"},
        tests::Fault{
            "velocities_alone", "t [s],vx_ned [m/s],vy_ned [m/s],vz_ned [m/s]\n0,0,0,0\n1,0,0,0\n",
            "s.csv:1: header: has no positions, must have x [m], y [m] and z [m]; `swiftlet stream` flies "
            "velocities, accelerations, attitudes and body rates"},
        tests::Fault{
            "no_frame", "t [s],x [m],y [m],z [m]\n0,0,0,1\n1,0,0,1\n",
            "s.csv:1: header: names no frame: write x_ned [m] (north, east, down), x_enu [m] (east, "
            "north, up) or x_nwu [m] (north, west, up), or add --frame ned, --frame enu or --frame nwu"},
        tests::Fault{"missing_field", "t,x,y,z\n0,0,0,1\n1,0,0\n",
                     "s.csv:3: has 3 fields, must have 4: t,x,y,z"},
        tests::Fault{"starts_in_motion",
                     "t,x,y,z,vx,vy,vz\n0,0,0,1,0.5,0,0\n1,0.5,0,1,0.5,0,0\n2,1,0,1,0,0,0\n",
                     "s.csv:2: the path starts at 0.50 m/s, must start at rest"},
        tests::Fault{
            "seems_to_start_in_motion",
            "t,x,y,z\n0,0,0,1\n0.1,0.05,0,1\n0.2,0.1,0,1\n0.3,0.1,0,1\n0.4,0.1,0,1\n",
            "s.csv:2: the path starts at about 0.50 m/s, must start at rest: segment 1 in ENU reaches "
            "14.42 m/s^2, the limit is 5.00 m/s^2"},
        tests::Fault{"seems_to_end_in_motion",
                     "t,x,y,z\n0,0,0,1\n0.1,0,0,1\n0.2,0,0,1\n0.3,0.05,0,1\n0.4,0.1,0,1\n",
                     "s.csv:3: the path ends at about 0.50 m/s, must end at rest: segment 4 in ENU reaches "
                     "5.60 m/s^2, the limit is 5.00 m/s^2"},
        tests::Fault{
            "step", "t,x,y,z\n0,0,0,1\n1,0,0,1\n1.01,0.3,0,1\n2,0.3,0,1\n",
            "s.csv:4: is 0.300 m from the row before, 0.01 s earlier: 30.00 m/s, the limit is 2.00 m/s"}),
    tests::name_of);

}  // namespace swiftlet::io::sampled_csv_test
