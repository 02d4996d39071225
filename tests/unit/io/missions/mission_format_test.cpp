#include "swiftlet/io/missions/mission_format.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/missions/geodesy.hpp"
#include "tests/unit/ground/fault.hpp"

namespace swiftlet::ground {
namespace {

using control::MissionItemKind;
using Eigen::Vector3d;

const std::string kData = SWIFTLET_SOURCE_DIR "/tests/data/";

control::Limits field() {
  control::Limits limits;
  limits.fence_min_ned = {-30, -30, -12};
  limits.fence_max_ned = {30, 30, 0.2};
  return limits;
}

template <class Parse>
std::string refusal(Parse&& parse) {
  try {
    parse();
  } catch (const runtime::ConfigError& error) {
    return error.what();
  }
  return "it was accepted";
}

bool assumes(const MissionFile& file, const std::string& part) {
  for (const std::string& assumption : file.assumptions) {
    if (assumption.find(part) != std::string::npos) return true;
  }
  return false;
}

control::Reference at_path_start(const MissionFile& file) {
  return control::evaluate(file.mission.segments.front(), 0.0);
}

TEST(DetectFormat, RecognisesEveryFormat) {
  EXPECT_EQ(detect_format("duration,x^0\n", "a.csv"), MissionFormat::kPolynomialCsv);
  EXPECT_EQ(detect_format("t,x,y,z\n", "a.csv"), MissionFormat::kSampledCsv);
  EXPECT_EQ(detect_format("t,x,y,z\n", "a.txt"), MissionFormat::kSampledCsv);
  EXPECT_EQ(detect_format("t [ms],x_ned [m]\n", "a.csv"), MissionFormat::kSampledCsv);
  EXPECT_EQ(detect_format("x,y,z\n", "a.csv"), MissionFormat::kWaypointCsv);
  EXPECT_EQ(detect_format("x_enu [cm],y_enu [cm],z_enu [cm]\n", "a.csv"), MissionFormat::kWaypointCsv);
  EXPECT_EQ(detect_format("\xef\xbb\xbf"
                          "0.0, 1.5,2e-1\r\n",
                          "a.csv"),
            MissionFormat::kWaypointCsv);
  EXPECT_EQ(detect_format("0,1,2,0.5\n", "a"), MissionFormat::kWaypointCsv);
  EXPECT_EQ(detect_format("\n  {\"fileType\": \"Plan\"}", "a.json"), MissionFormat::kQGroundControlPlan);
  EXPECT_EQ(detect_format("", "a.plan"), MissionFormat::kQGroundControlPlan);
  EXPECT_EQ(detect_format("frame: ned\n", "a.yaml"), MissionFormat::kYaml);
  EXPECT_EQ(detect_format("frame: ned\n", "a"), MissionFormat::kYaml);
}

TEST(DetectFormat, ErrorListsTheKnownCsvHeaders) {
  const std::string known =
      "duration,x^0,... (polynomials), t,x,y,z,... (samples) or x,y,z[,yaw] (waypoints, also without a "
      "header); x may be x_ned [m]";
  EXPECT_EQ(refusal([] { detect_format("", "a.csv"); }), "a.csv: is empty, must hold " + known);
  EXPECT_EQ(refusal([] { detect_format("1,2,3,4,5\n", "a.csv"); }),
            "a.csv:1: has 5 fields, of which the first is 1; must begin with " + known);
  EXPECT_EQ(refusal([] { detect_format("north,east\n", "a.CSV"); }),
            "a.CSV:1: has 2 fields, of which the first is north; must begin with " + known);
}

// Polynomials

std::string header() {
  std::string text = "duration";
  for (const char* axis : {"x", "y", "z", "yaw"}) {
    for (int k = 0; k < 8; ++k) text += std::string(",") + axis + "^" + std::to_string(k);
  }
  return text;
}
const std::string kHeader = header();

// Minimum jerk from rest at x to rest at x + distance east, at a height.
std::string row(double duration_s, double x, double distance, double height, double yaw = 0.0) {
  const control::PolynomialSegment s =
      control::minimum_jerk({x, 0, height}, yaw, {x + distance, 0, height}, yaw, duration_s);
  std::string text = runtime::exact(duration_s);
  for (const control::Polynomial* const axis : {&s.x, &s.y, &s.z, &s.yaw}) {
    for (const double c : *axis) text += "," + runtime::exact(c);
  }
  return text;
}

MissionFile polynomials(const std::string& text) {
  return parse_polynomial_csv(text, "p.csv", control::Limits());
}

TEST(PolynomialCsv, ConvertsEnuToNed) {
  const MissionFile file = polynomials(kHeader + "\n" + row(4.0, 0.5, 1.0, 1.5, 0.3) + "\n");
  EXPECT_EQ(file.name, "p");
  ASSERT_EQ(file.mission.items.size(), 3U);
  EXPECT_EQ(file.mission.items[0].kind, MissionItemKind::kTakeoff);
  EXPECT_NEAR(file.mission.items[0].position_ned.z(), -1.5, 1e-9);
  EXPECT_EQ(file.mission.items[1].kind, MissionItemKind::kTrajectory);
  EXPECT_EQ(file.mission.items[1].segment_count, 1U);
  EXPECT_EQ(file.mission.items[2].kind, MissionItemKind::kLand);
  const control::PolynomialSegment& segment = file.mission.segments.front();
  const control::Reference start = at_path_start(file);
  EXPECT_LT((start.position_ned - Vector3d(0, 0.5, -1.5)).norm(), 1e-6);
  EXPECT_NEAR(start.yaw_rad, M_PI / 2 - 0.3, 1e-6);
  EXPECT_LT((control::evaluate(segment, 4.0).position_ned - Vector3d(0, 1.5, -1.5)).norm(), 1e-3);
  EXPECT_TRUE(assumes(file, "ENU"));
  EXPECT_TRUE(assumes(file, "above the ground: the lowest point is 1.50 m"));
  EXPECT_TRUE(assumes(file, "take-off to 1.50 m and a landing are added"));
}

TEST(PolynomialCsv, RaisesALowPathToTheHoverHeight) {
  const MissionFile file = polynomials(kHeader + "\n" + row(4.0, 0.5, 1.0, 0.1));
  EXPECT_NEAR(at_path_start(file).position_ned.z(), -1.0, 1e-9);
  EXPECT_TRUE(assumes(file, "raised by 0.90 m"));
}

TEST(PolynomialCsv, ReadsACrazyswarmFile) {
  const MissionFile file = load_mission_file(kData + "crazyswarm_figure8.csv", control::Limits());
  EXPECT_EQ(file.name, "crazyswarm_figure8");
  EXPECT_EQ(file.mission.segments.size(), 10U);
  const control::Reference end =
      control::evaluate(file.mission.segments.back(), file.mission.segments.back().duration_s);
  EXPECT_LT((end.position_ned - Vector3d(0, 0, -1)).norm(), 1e-3);
  EXPECT_TRUE(control::check(file.mission, control::Limits()).accepted);
}

std::string replaced(const std::string& text, std::size_t column, const std::string& value) {
  std::size_t begin = 0;
  for (; column > 0; --column) begin = text.find(',', begin) + 1;
  const std::size_t end = text.find(',', begin);
  return text.substr(0, begin) + value + (end == std::string::npos ? "" : text.substr(end));
}
const std::string kRow = row(4.0, 0.0, 1.0, 1.0);

class BadPolynomialCsv : public testing::TestWithParam<Fault> {};
TEST_P(BadPolynomialCsv, IsRefusedWithASentence) {
  EXPECT_EQ(refusal([] { polynomials(GetParam().text); }), GetParam().sentence);
}

std::string repeated_hover(int rows) {
  std::string text = kHeader + "\n";
  for (int i = 0; i < rows; ++i) text += row(0.5, 0.0, 0.0, 1.0) + "\n";
  return text;
}

INSTANTIATE_TEST_SUITE_P(
    , BadPolynomialCsv,
    testing::Values(
        Fault{"empty", "", "p.csv: is empty, must begin with the header " + kHeader},
        Fault{"no_rows", kHeader + "\n", "p.csv: has 0 rows behind the header, must have at least 1"},
        Fault{"missing_column", kHeader + "\n" + kRow.substr(0, kRow.rfind(',')) + "\n",
              "p.csv:2: has 32 fields, must have 33: " + kHeader},
        Fault{"extra_column", kHeader + "\n" + kRow + "\n" + kRow + ",1\n",
              "p.csv:3: has 34 fields, must have 33: " + kHeader},
        Fault{"two_trailing_commas", kHeader + "\n" + kRow + ",,\n",
              "p.csv:2: has 34 fields, must have 33: " + kHeader},
        Fault{"nan", kHeader + "\n" + replaced(kRow, 4, "nan"),
              "p.csv:2: x^3: is nan, must be a finite number"},
        Fault{"infinity", kHeader + "\n" + replaced(kRow, 32, "-inf"),
              "p.csv:2: yaw^7: is -inf, must be a finite number"},
        Fault{"word", kHeader + "\n" + replaced(kRow, 9, "north"),
              "p.csv:2: y^0: is north, must be a finite number"},
        Fault{"zero_duration", kHeader + "\n" + replaced(kRow, 0, "0"),
              "p.csv:2: duration: is 0, must be above 0 and at most 3600 s"},
        Fault{"duration_above_limit", kHeader + "\n" + replaced(kRow, 0, "3600.1"),
              "p.csv:2: duration: is 3600.1, must be above 0 and at most 3600 s"},
        Fault{"too_many_segments", repeated_hover(1025),
              "p.csv:1026: duration: is segment 1025, at most 1024 fit"},
        Fault{"outside_the_fence", kHeader + "\n" + row(9.0, 0.0, 3.01, 1.0),
              "p.csv:2: segment 1 in NED: y is 3.010 m, outside the fence of -3.000 to 3.000 m"},
        Fault{"too_fast", kHeader + "\n" + row(1.8, 0.0, 2.0, 1.0),
              "p.csv:2: segment 1 in NED reaches 2.08 m/s, the limit is 2.00 m/s"},
        Fault{"discontinuous", kHeader + "\n" + row(4.0, 0.0, 1.0, 1.0) + "\n" + row(4.0, 1.1, 1.0, 1.0),
              "p.csv:3: segment 2 in NED does not start where the previous one ends: 0.100 m and 0.000 m/s "
              "apart"},
        Fault{"starts_in_motion", kHeader + "\n" + replaced(kRow, 2, "0.5"),
              "p.csv:2: segment 1 in NED starts at 0.50 m/s, must start at rest"}),
    name_of);

TEST(PolynomialCsv, AcceptsTheMaximumOfSegments) {
  EXPECT_EQ(polynomials(repeated_hover(1024)).mission.segments.size(), 1024U);
}

// Samples

MissionFile samples(const std::string& text) { return parse_sampled_csv(text, "s.csv", control::Limits()); }

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
  EXPECT_TRUE(assumes(file, "41 samples became 40 segments of minimum snap"));
  EXPECT_TRUE(assumes(file, "no yaw"));
}

TEST(SampledCsv, ReducesExcessSamplesAndReportsTheDeviation) {
  const MissionFile file = samples(sampled(1000.0, "t,x,y,z,vx,vy,vz,ax,ay,az"));
  EXPECT_EQ(file.mission.segments.size(), 1024U);
  EXPECT_LT(furthest_from_truth(file), 1e-4);
  EXPECT_TRUE(assumes(file, "4001 samples became 1024 segments"));
  EXPECT_TRUE(assumes(file, "largest deviation is 0.0 mm"));
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
    return at_path_start(parse_sampled_csv(header + "\n" + rows, "s.csv", control::Limits(), frame));
  };
  const Vector3d there(0.1, 0.2, -1.0);
  EXPECT_LT((at_start("t [ms],x_ned [cm],y_ned [cm],z_ned [cm]", {}).position_ned - there).norm(), 1e-12);
  EXPECT_LT((at_start("t [ms],x [cm],y [cm],z [cm]", MissionFrame::kNed).position_ned - there).norm(), 1e-12);
  EXPECT_EQ(refusal([&] { at_start("t [ms],x_ned [cm],y_ned [cm],z_ned [cm]", MissionFrame::kEnu); }),
            "s.csv:1: header: names the frame ned, but --frame names enu");
  const MissionFile file = samples(
      "z_enu [m],t [s],y_enu [m],x_enu [m],yaw_enu [deg],yaw_rate_enu [deg/s],ax_enu [m/s^2],"
      "ay_enu [m/s^2],az_enu [m/s^2]\n1,0,0.2,0.1,90,0,0,0,0\n1,1,0.2,0.1,90,0,0,0,0\n");
  EXPECT_LT((at_path_start(file).position_ned - Vector3d(0.2, 0.1, -1.0)).norm(), 1e-12);
  EXPECT_NEAR(at_path_start(file).yaw_rad, 0.0, 1e-12);
  EXPECT_FALSE(assumes(file, "taken as")) << "the header says all";
  EXPECT_TRUE(assumes(file, "accelerations are not used"));
  EXPECT_TRUE(assumes(file, "yaw_rate is not used"));
}

TEST(CsvFrame, OfAFileThatNamesNoneIsThatOfTheOption) {
  const control::Limits limits;
  const auto ned = MissionFrame::kNed;
  EXPECT_EQ(
      at_path_start(parse_sampled_csv("t,x,y,z\n0,1,2,-1\n4,1,2,-1\n", "s.csv", limits, ned)).position_ned,
      Vector3d(1, 2, -1));
  EXPECT_EQ(at_path_start(parse_waypoint_csv("1,2,-1\n1,1,-1\n", "w.csv", limits, ned)).position_ned,
            Vector3d(1, 2, -1));
  EXPECT_EQ(at_path_start(parse_waypoint_csv("x_ned [cm],y_ned [cm],z_ned [cm]\n100,200,-100\n100,100,-100\n",
                                             "w.csv", limits))
                .position_ned,
            Vector3d(1, 2, -1));
  EXPECT_LT(
      (at_path_start(parse_polynomial_csv(kHeader + "\n" + row(4.0, 0.5, 1.0, -1.5), "p.csv", limits, ned))
           .position_ned -
       Vector3d(0.5, 0, -1.5))
          .norm(),
      1e-9);
}

// Flight records

// A vertical take-off to 1 m, `moves` m north in 2 s and back, and a landing, at 100 Hz; 20 ms on the ground
// have no reference.
std::string flight_table(const std::string& header, bool older) {
  std::string text = header + "\n0,,0,\n0.01,,0,\n";
  double begin_s = 0.02;
  const auto fly = [&](const Vector3d& from, const Vector3d& to, double duration_s) {
    const control::PolynomialSegment s = control::minimum_jerk(from, 0.3, to, 0.3, duration_s);
    for (int i = 0; i < std::lround(duration_s * 100); ++i) {
      const control::Reference r = control::evaluate(s, i * 0.01);
      text += runtime::exact(begin_s + i * 0.01) + (older ? ",4,0" : ",mission,0");
      const auto add = [&](const Vector3d& v) {
        for (int axis = 0; axis < 3; ++axis) text += "," + runtime::exact(v[axis]);
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
    EXPECT_TRUE(assumes(file, "the reference of a recorded flight between take-off and landing, t = 2.9"))
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
            "s.csv:1: header: has no column ref_py, which the flight.csv of a record has");
}

class BadSampledCsv : public testing::TestWithParam<Fault> {};
TEST_P(BadSampledCsv, IsRefusedWithASentence) {
  EXPECT_EQ(refusal([] { samples(GetParam().text); }), GetParam().sentence);
}
INSTANTIATE_TEST_SUITE_P(
    , BadSampledCsv,
    testing::Values(
        Fault{"one_row", "t,x,y,z\n0,0,0,1\n", "s.csv: has 1 rows behind the header, must have at least 2"},
        Fault{"time_repeats", "t,x,y,z\n0,0,0,1\n1,0,0,1\n1,0,0,1\n",
              "s.csv:4: t: is 1, must be at least 1.0001 and at most 3601 s"},
        Fault{"time_decreases", "t,x,y,z\n5,0,0,1\n4,0,0,1\n",
              "s.csv:3: t: is 4, must be at least 5.0001 and at most 3605 s"},
        Fault{"nan", "t,x,y,z\n0,0,0,1\n1,0,nan,1\n", "s.csv:3: y: is nan, must be a finite number"},
        Fault{"part_of_a_velocity", "t,x,y,z,vx\n0,0,0,1,0\n",
              "s.csv:1: header: has no column vy [m/s], must have vx [m/s], vy [m/s] and vz [m/s]"},
        Fault{"unused_column", "t,x,y,z,roll\n0,0,0,1,0\n",
              "s.csv:1: header: has the column roll [rad], which a trajectory does not use"},
        Fault{"velocities_alone", "t [s],vx_ned [m/s],vy_ned [m/s],vz_ned [m/s]\n0,0,0,0\n1,0,0,0\n",
              "s.csv:1: header: has no positions, must have x [m], y [m] and z [m]; `swiftlet stream` flies "
              "velocities, accelerations, attitudes and body rates"},
        Fault{"no_frame", "t [s],x [m],y [m],z [m]\n0,0,0,1\n1,0,0,1\n",
              "s.csv:1: header: names no frame: write x_ned [m] (north, east, down) or x_enu [m] (east, "
              "north, up), or add --frame ned or --frame enu"},
        Fault{"missing_field", "t,x,y,z\n0,0,0,1\n1,0,0\n", "s.csv:3: has 3 fields, must have 4: t,x,y,z"},
        Fault{"starts_in_motion", "t,x,y,z,vx,vy,vz\n0,0,0,1,0.5,0,0\n1,0.5,0,1,0.5,0,0\n2,1,0,1,0,0,0\n",
              "s.csv:2: segment 1 in NED starts at 0.50 m/s, must start at rest"}),
    name_of);

// Waypoints

MissionFile waypoints(const std::string& text) {
  return parse_waypoint_csv(text, "w.csv", control::Limits());
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

class BadWaypointCsv : public testing::TestWithParam<Fault> {};
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
        Fault{"one_point", "0,0,1\n", "w.csv: has 1 rows, must have at least 2"},
        Fault{"missing_field", "0,0,1\n1,0\n", "w.csv:2: has 2 fields, must have 3: x,y,z"},
        Fault{"infinite", "0,0,1\n1,inf,1\n", "w.csv:2: y: is inf, must be a finite number"},
        Fault{"degrees", "0,0,1,0\n1,0,1,90\n",
              "w.csv:2: yaw: waypoint 2: yaw is 90 rad, more than a full turn: 90 degrees are 1.5708 "
              "rad, 90 rad are the yaw 2.0354 rad"},
        Fault{"outside_the_fence", "0,0,1\n3.1,0,1\n",
              "w.csv:2: x,y,z: in NED: y is 3.100 m, outside the fence of -3.000 to 3.000 m"},
        Fault{"equal_points", "0,0,1\n0,0,1\n", "w.csv: the path has no length: all points are at one place"},
        Fault{"too_many_points", hover_points(1026),
              "w.csv:1026: x,y,z: is waypoint 1026, at most 1025 fit"}),
    name_of);

TEST(WaypointCsv, NamesTheWaypointBeforeAFenceViolation) {
  const std::string sentence = refusal([] { waypoints("0,0,1\n3,0,1\n3,2.9,1\n0,0,1\n"); });
  EXPECT_EQ(sentence.find("w.csv:2: the path from here: segment 2 in NED: y is "), 0U) << sentence;
  EXPECT_NE(sentence.find("outside the fence of -3.000 to 3.000 m"), std::string::npos) << sentence;
}

TEST(WaypointCsv, AcceptsTheMaximumOfPoints) {
  EXPECT_EQ(waypoints(hover_points(1025)).mission.segments.size(), 1024U);
}

// QGroundControl

std::string item(int command, int frame, const std::string& params) {
  return "{\"type\": \"SimpleItem\", \"command\": " + std::to_string(command) +
         ", \"frame\": " + std::to_string(frame) + ", \"params\": [" + params + "], \"autoContinue\": true}";
}
std::string plan(const std::string& items, const std::string& home = "47.4, 8.5, 488") {
  return "{\n\"fileType\": \"Plan\", \"version\": 1,\n\"mission\": {\"hoverSpeed\": 0.8, "
         "\"plannedHomePosition\": [" +
         home + "],\n\"items\": [\n" + items + "\n]}}\n";
}
MissionFile qgc(const std::string& text, const control::Limits& limits = control::Limits()) {
  return parse_qgroundcontrol_plan(text, "q.plan", limits);
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
  EXPECT_EQ(items[1].speed, 2.0);
  EXPECT_LT((items[5].position_ned - items[4].position_ned).norm(), 0.1);  // above where it lands
  EXPECT_EQ(items[6].kind, MissionItemKind::kLand);
  EXPECT_TRUE(assumes(file, "home, 47.3977420, 8.5455940 deg and 488.0 m, is the origin"));
  EXPECT_TRUE(assumes(file, "the plan wants 5 m/s"));
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
  EXPECT_EQ(items[1].speed, 0.8);
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

const std::string kUp = item(22, 1, "0,0,0,null,null,null,-1");

class BadPlan : public testing::TestWithParam<Fault> {};
TEST_P(BadPlan, IsRefusedWithASentence) {
  EXPECT_EQ(refusal([] { qgc(GetParam().text); }), GetParam().sentence);
}
INSTANTIATE_TEST_SUITE_P(
    , BadPlan,
    testing::Values(
        Fault{"empty", "", "q.plan:1: column 1: the file is empty, must be a JSON document"},
        Fault{"truncated", "{\n \"fileType\": \"Plan\",\n \"mission", "q.plan:3: column 9: is invalid JSON"},
        Fault{"number_overflow", plan(item(16, 1, "0,0,0,null,1e309,1,-1")),
              "q.plan: holds a number beyond 1.8e308, must hold smaller ones"},
        Fault{"other_file_type", "{\"fileType\": \"Fence\"}", "q.plan:1: fileType: is Fence, must be Plan"},
        Fault{"no_items", plan(""), "q.plan:4: mission.items: is a list of 0, must be a list of 1 to 2048"},
        Fault{"unsupported_command", plan(kUp + ",\n" + item(206, 2, "1,2,3,4,5,6,7")),
              "q.plan:6: mission.items[1].command: is 206, must be 16 (waypoint), 19 (loiter for a time), 20 "
              "(return to "
              "launch), 21 (land), 22 (take-off) or 178 (change speed)"},
        Fault{"complex_item", plan("{\"type\": \"ComplexItem\"}"),
              "q.plan:5: mission.items[0].type: is ComplexItem, must be SimpleItem: draw the pattern as "
              "waypoints"},
        Fault{"unknown_frame", plan(item(16, 10, "0,0,0,null,1,1,1")),
              "q.plan:5: mission.items[0].frame: is 10, must be 0 or 3 (global, altitude above the sea or "
              "above home), 1 (local "
              "NED) or 4 (local ENU)"},
        Fault{"six_parameters", plan(item(16, 1, "0,0,0,null,1,1")),
              "q.plan:5: mission.items[0].params: is a list of 6, must be a list of 7"},
        Fault{"no_latitude", plan(item(16, 3, "0,0,0,null,null,8.5,1")),
              "q.plan:5: mission.items[0].params[4]: is empty, must be a number"},
        Fault{"latitude_out_of_range", plan(item(16, 3, "0,0,0,null,90.5,8.5,1")),
              "q.plan:5: mission.items[0].params[4]: is 90.5, must be at least -90 and at most 90"},
        Fault{"home_out_of_range", plan(kUp, "47, 181, 0"),
              "q.plan:3: mission.plannedHomePosition[1]: is 181, must be at least -180 and at most 180"},
        Fault{"outside_the_fence", plan(kUp + ",\n" + item(16, 1, "0,0,0,null,3.5,1,-1")),
              "q.plan:6: mission.items[1]: north is 3.500 m, must be inside the fence, -3 to 3 m"},
        Fault{
            "takes_off_elsewhere", plan(item(22, 1, "0,0,0,null,2,0,-1")),
            "q.plan:5: mission.items[0]: takes off 2.0 m from home, must be at most 1 m: the vehicle stands "
            "at home"},
        Fault{"lands_first", plan(item(21, 1, "0,0,0,null,0,0,0")),
              "q.plan:5: mission.items[0]: is the first item, must follow a take-off or a waypoint"},
        Fault{"item_after_landing",
              plan(kUp + ",\n" + item(21, 1, "0,0,0,null,0,0,0") + ",\n" + item(16, 1, "0,0,0,null,0,0,-1")),
              "q.plan:7: mission.items[2]: follows a landing, which must be the last item"},
        Fault{"hold_above_limit", plan(item(16, 1, "3601,0,0,null,1,1,-1")),
              "q.plan:5: mission.items[0].params[0]: is 3601, must be at least 0 and at most 3600"},
        Fault{"zero_speed", plan(item(178, 2, "1,0,-1,0,0,0,0")),
              "q.plan:5: mission.items[0].params[1]: is 0, must be above 0"},
        Fault{"no_item_to_fly", plan(item(178, 2, "1,1,-1,0,0,0,0")),
              "q.plan:4: mission.items: has no item to fly, must have a take-off or a waypoint"}),
    name_of);

TEST(QGroundControlPlan, RequiresAHomeForGeographicItems) {
  std::string text = plan(item(16, 3, "0,0,0,null,47,8,1"));
  const std::size_t begin = text.find("\"plannedHomePosition\"");
  text.erase(begin, text.find("],", begin) + 2 - begin);
  EXPECT_EQ(refusal([&] { qgc(text); }),
            "q.plan:3: mission: has items with geographic coordinates, must have a plannedHomePosition");
}

TEST(Geodesy, MatchesTheWgs84Ellipsoid) {
  // A degree of latitude and of longitude at 45 deg north, WGS 84: 111,132 m and 78,847 m.
  const GeographicPosition home{45.0, 179.9999};
  EXPECT_NEAR(north_east_of(home, {45.01, 179.9999}).x(), 1111.32, 0.05);
  EXPECT_NEAR(north_east_of(home, {45.0, -179.9901}).y(), 788.47, 0.05);  // across the date line
  EXPECT_NEAR(north_east_of(home, {44.99, 179.9999}).x(), -1111.32, 0.05);
}

}  // namespace
}  // namespace swiftlet::ground
