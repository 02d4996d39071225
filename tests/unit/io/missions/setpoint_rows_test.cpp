#include "swiftlet/io/missions/setpoint_rows.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/math/euler.hpp"

namespace swiftlet::io::setpoint_rows_test {

using control::SetpointKind;
using Eigen::Vector3d;

SetpointRows reader(const std::string& header, const std::string& file,
                    std::optional<MissionFrame> frame = std::nullopt) {
  return {io::first_csv_line(header, file), file, frame};
}

std::string refusal(const std::string& header, const std::vector<std::string>& lines = {},
                    std::optional<MissionFrame> frame = std::nullopt) {
  try {
    SetpointRows rows = reader(header, "s.csv", frame);
    for (const std::string& line : lines) rows.read(line);
  } catch (const io::ConfigError& error) {
    return error.what();
  }
  return "none";
}

TEST(SetpointRows, DetectKindFromColumns) {
  const auto kind = [](const std::string& header) { return reader(header, "f", MissionFrame::kNed).kind(); };
  EXPECT_EQ(kind("t [s],x [m],y [m],z [m]"), SetpointKind::kPosition);
  EXPECT_EQ(kind("t [s],vx [m/s],vy [m/s],vz [m/s],x [m],y [m],z [m]"), SetpointKind::kPosition);
  EXPECT_EQ(kind("t [s],vx_ned [m/s],vy_ned [m/s],vz_ned [m/s],yaw_rate_ned [deg/s]"),
            SetpointKind::kVelocity);
  EXPECT_EQ(kind("t [s],ax [m/s^2],ay [m/s^2],az [m/s^2]"), SetpointKind::kAcceleration);
  EXPECT_EQ(kind("t [s],roll [deg],pitch [deg],yaw [deg],thrust [g]"), SetpointKind::kAttitude);
  EXPECT_EQ(kind("thrust [m/s^2],p_frd [rad/s],q_frd [rad/s],r_frd [rad/s],t [ms]"),
            SetpointKind::kBodyRates);
}

TEST(SetpointRows, RefusePositionsBelowTheGround) {
  EXPECT_EQ(refusal("t [s],x_ned [m],y_ned [m],z_ned [m]", {"0,0,0,-1", "1,0,0,0.1"}),
            "s.csv:3: z: in NED: z = +0.100 m is below the ground, as z points down (NED); 0.100 m above the "
            "ground "
            "is z = -0.100 m");
  EXPECT_EQ(refusal("t,x,y,z", {"0,0,0,-1"}),
            "s.csv:2: z: in ENU: z = -1.000 m is below the ground, as z points up (ENU); 1.000 m above the "
            "ground is z = 1.000 m");
  EXPECT_EQ(refusal("t [s],vx_ned [m/s],vy_ned [m/s],vz_ned [m/s]", {"0,0,0,1"}), "none");
}

TEST(SetpointRows, RefuseBinaryInputWithoutShowingIt) {
  EXPECT_EQ(refusal("t,x\x01\x1b[31m,y,z"), "s.csv:1: is not a text file: it has control characters");
  EXPECT_EQ(refusal("t,x,y,z", {"0,0,0,\x1b"}), "s.csv:2: is not a text file: it has control characters");
}

TEST(SetpointRows, ConvertToSiUnits) {
  SetpointRows rows = reader("t [ms],vy_ned [cm/s],vx_ned [m/s],vz_ned [m/s],yaw_ned [deg]", "f");
  const auto row = rows.read("500, 20, 0.3, -0.1, 90\r");
  ASSERT_TRUE(row);
  EXPECT_EQ(row->time_s, 0.5);
  EXPECT_EQ(row->setpoint.velocity_ned, Vector3d(0.3, 0.2, -0.1));
  EXPECT_FALSE(row->setpoint.yaw_free);
  EXPECT_NEAR(row->setpoint.yaw_rad, M_PI / 2, 1e-12);
  EXPECT_FALSE(rows.read("")) << "a blank line is no row";
  SetpointRows attitudes = reader("t [s],roll [deg],pitch [deg],yaw [deg],thrust [g]", "f");
  const auto attitude = attitudes.read("0,10,-5,30,1");
  EXPECT_NEAR(attitude->setpoint.specific_thrust, 9.80665, 1e-12);
  const Vector3d euler = math::euler_angles(attitude->setpoint.q_ned_from_frd).vector();
  EXPECT_LT((euler * 180.0 / M_PI - Vector3d(10, -5, 30)).norm(), 1e-9);
}

TEST(SetpointRows, TakeTheFrameFromTheHeaderOrTheOption) {
  const auto position = [](const std::string& header, std::optional<MissionFrame> frame,
                           const char* row = "0,1,2,-3") {
    return reader(header, "f", frame).read(row)->setpoint.position_ned;
  };
  EXPECT_EQ(position("t [s],x_ned [m],y_ned [m],z_ned [m]", {}), Vector3d(1, 2, -3));
  EXPECT_EQ(position("t [s],x_enu [m],y_enu [m],z_enu [m]", {}, "0,1,2,3"), Vector3d(2, 1, -3));
  EXPECT_EQ(position("t [s],x [m],y [m],z [m]", MissionFrame::kNed), Vector3d(1, 2, -3));
  EXPECT_EQ(position("t,x,y,z", MissionFrame::kNed), Vector3d(1, 2, -3));
  EXPECT_EQ(position("t,x,y,z", MissionFrame::kEnu, "0,1,2,3"), Vector3d(2, 1, -3));
  EXPECT_FALSE(reader("t,x,y,z", "f", MissionFrame::kNed).assumption());
  const auto turning =
      reader("t [s],vx_enu [m/s],vy_enu [m/s],vz_enu [m/s],yaw_rate_enu [rad/s]", "f").read("0,1,2,3,0.5");
  EXPECT_EQ(turning->setpoint.velocity_ned, Vector3d(2, 1, -3));
  EXPECT_EQ(turning->setpoint.yaw_rate, -0.5) << "clockwise from north";
}

TEST(SetpointRows, RefuseToGuessAFrame) {
  const std::string sentence =
      "s.csv:1: header: names no frame: write x_ned [m] (north, east, down), x_enu [m] (east, north, up) "
      "or x_nwu [m] (north, west, up), or add --frame ned, --frame enu or --frame nwu";
  EXPECT_EQ(refusal("t [s],x [m],y [m],z [m]"), sentence);
  EXPECT_EQ(refusal("t [s],x_ned [m],y_enu [m],z_ned [m]"),
            "s.csv:1: header: mixes _ned and _enu, must name one frame");
  EXPECT_EQ(refusal("t [s],x_ned [m],y_ned [m],z_ned [m]", {}, MissionFrame::kEnu),
            "s.csv:1: header: names the frame ned, but --frame names enu");
  EXPECT_EQ(refusal("t [s],p [rad/s],q [rad/s],r [rad/s],thrust [g]", {}, MissionFrame::kEnu),
            "s.csv:1: header: has attitudes or body rates in ENU, must have them in NED and FRD");
}

TEST(SetpointRows, AssumeEnuPositionsWithoutUnits) {
  SetpointRows rows = reader("t,x,y,z,yaw", "f");
  ASSERT_TRUE(rows.assumption());
  EXPECT_NE(rows.assumption()->find("in ENU"), std::string::npos);
  const auto row = rows.read("0,1,2,3,0");
  EXPECT_EQ(row->setpoint.position_ned, Vector3d(2, 1, -3));
  EXPECT_NEAR(row->setpoint.yaw_rad, M_PI / 2, 1e-12) << "east";
  EXPECT_NE(refusal("t,vx,vy,vz").find("has no units, must have them"), std::string::npos);
}

TEST(SetpointRows, RefuseInvalidColumnsAndRows) {
  EXPECT_EQ(refusal("t [s],x_ned [m],y_ned [m]"),
            "s.csv:1: header: has no column z [m], must have x [m], y [m] and z [m]");
  EXPECT_EQ(
      refusal("x_ned [m],y_ned [m],z_ned [m]"),
      "s.csv:1: header: has no column t [s], must have it; a list of waypoints is flown by `swiftlet fly`");
  EXPECT_EQ(
      refusal("t [s],x_ned [ft],y_ned [m],z_ned [m]"),
      "s.csv:1: header: has the column x_ned [ft] with an unknown unit, must be x_ned [m] or x_ned [cm] or "
      "x_ned [mm]");
  EXPECT_EQ(refusal("t [s],x,y [m],z [m]"),
            "s.csv:1: header: has the column x without a unit, must be x [m] or x [cm] or x [mm]");
  EXPECT_EQ(refusal("t [s],x_ned [m],y_ned [m],z_ned [m],thrust [g]"),
            "s.csv:1: header: has the column thrust [m/s^2], which a stream of positions does not use");
  EXPECT_EQ(refusal("t [s],x_ned [m],x_ned [m],y_ned [m],z_ned [m]"),
            "s.csv:1: header: has the column x twice, must have it once");
  EXPECT_NE(refusal("t [s],height [m]").find("has the column height [m], must be t [s], x_ned [m]"),
            std::string::npos);
  EXPECT_NE(refusal("t [s],roll_ned [rad]").find("has the column roll_ned [rad], must be"),
            std::string::npos);
  EXPECT_NE(refusal("t [s]").find("names no setpoint"), std::string::npos);
  const std::string header = "t [s],x_ned [m],y_ned [m],z_ned [m]";
  EXPECT_EQ(refusal(header, {"0,0,0,-1", "0,0,0,-1"}),
            "s.csv:3: t: is 0 s, must be above that of the previous row, 0 s");
  EXPECT_EQ(refusal(header, {"0,0,0"}),
            "s.csv:2: has 3 fields, must have 4: t [s],x_ned [m],y_ned [m],z_ned [m]");
  for (const char* text : {"nan", "inf", "up", ""})
    EXPECT_EQ(refusal(header, {std::string("0,") + text + ",0,-1"}), std::string("s.csv:2: x_ned [m]: is ") +
                                                                         (*text == '\0' ? "empty" : text) +
                                                                         ", must be a finite number");
}

SetpointSource of(std::vector<TimedSetpoint> rows) {
  return [rows = std::move(rows), next = std::size_t{0}]() mutable -> std::optional<TimedSetpoint> {
    if (next == rows.size()) return std::nullopt;
    return rows[next++];
  };
}

TEST(Resampled, InterpolatesLinearlyAndTakesTheShorterTurn) {
  TimedSetpoint a, b;
  a.time_s = 2.0;
  a.setpoint.yaw_rad = 3.0;
  b.time_s = 3.0;
  b.setpoint.position_ned = {1, 2, 3};
  b.setpoint.yaw_rad = -3.0;
  const SetpointSource source = resampled(of({a, b}), 4.0);
  for (int i = 0; i < 4; ++i) {
    const auto row = source();
    ASSERT_TRUE(row);
    EXPECT_NEAR(row->time_s, 2.0 + 0.25 * i, 1e-12);
    EXPECT_LT((row->setpoint.position_ned - 0.25 * i * Vector3d(1, 2, 3)).norm(), 1e-12);
    EXPECT_NEAR(row->setpoint.yaw_rad, 3.0 + 0.25 * i * (2.0 * M_PI - 6.0), 1e-12);
  }
  const auto last = source();
  ASSERT_TRUE(last);
  EXPECT_EQ(last->setpoint.position_ned, b.setpoint.position_ned);
  EXPECT_FALSE(source());
  EXPECT_FALSE(resampled(of({}), 4.0)());
}

}  // namespace swiftlet::io::setpoint_rows_test
