#include "swiftlet/io/missions/setpoint_rows.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/math/euler.hpp"

namespace swiftlet::ground {
namespace {

using control::SetpointKind;
using Eigen::Vector3d;

std::string refusal(const std::string& header, const std::vector<std::string>& lines = {}) {
  try {
    SetpointRows rows(header, "s.csv");
    for (const std::string& line : lines) rows.read(line);
  } catch (const runtime::ConfigError& error) {
    return error.what();
  }
  return "none";
}

TEST(SetpointRows, DetectKindFromColumns) {
  EXPECT_EQ(SetpointRows("t [s],x [m],y [m],z [m]", "f").kind(), SetpointKind::kPosition);
  EXPECT_EQ(SetpointRows("t [s],vx [m/s],vy [m/s],vz [m/s],x [m],y [m],z [m]", "f").kind(),
            SetpointKind::kPosition);
  EXPECT_EQ(SetpointRows("t [s],vx [m/s],vy [m/s],vz [m/s],yaw_rate [deg/s]", "f").kind(),
            SetpointKind::kVelocity);
  EXPECT_EQ(SetpointRows("t [s],ax [m/s^2],ay [m/s^2],az [m/s^2]", "f").kind(), SetpointKind::kAcceleration);
  EXPECT_EQ(SetpointRows("t [s],roll [deg],pitch [deg],yaw [deg],thrust [g]", "f").kind(),
            SetpointKind::kAttitude);
  EXPECT_EQ(SetpointRows("thrust [m/s^2],p [rad/s],q [rad/s],r [rad/s],t [ms]", "f").kind(),
            SetpointKind::kBodyRates);
}

TEST(SetpointRows, RefusePositionsBelowTheGround) {
  EXPECT_EQ(refusal("t [s],x [m],y [m],z [m]", {"0,0,0,-1", "1,0,0,0.1"}),
            "s.csv:3: z: in NED: z = +0.100 m is below the ground, as z points down (NED); 0.100 m above the "
            "ground "
            "is z = -0.100 m");
  EXPECT_NE(refusal("t,x,y,z", {"0,0,0,-1"}).find("s.csv:2: z: in NED: z = +1.000 m is below"),
            std::string::npos);
  EXPECT_EQ(refusal("t [s],vx [m/s],vy [m/s],vz [m/s]", {"0,0,0,1"}), "none");
}

TEST(SetpointRows, RefuseBinaryInputWithoutShowingIt) {
  EXPECT_EQ(refusal("t,x\x01\x1b[31m,y,z"), "s.csv:1: is not a text file: it has control characters");
  EXPECT_EQ(refusal("t,x,y,z", {"0,0,0,\x1b"}), "s.csv:2: is not a text file: it has control characters");
}

TEST(SetpointRows, ConvertToSiUnits) {
  SetpointRows rows("t [ms],vy [cm/s],vx [m/s],vz [m/s],yaw [deg]", "f");
  const auto row = rows.read("500, 20, 0.3, -0.1, 90\r");
  ASSERT_TRUE(row);
  EXPECT_EQ(row->time_s, 0.5);
  EXPECT_EQ(row->setpoint.velocity_ned, Vector3d(0.3, 0.2, -0.1));
  EXPECT_FALSE(row->setpoint.yaw_free);
  EXPECT_NEAR(row->setpoint.yaw_rad, M_PI / 2, 1e-12);
  EXPECT_FALSE(rows.read("")) << "a blank line is no row";
  SetpointRows attitudes("t [s],roll [deg],pitch [deg],yaw [deg],thrust [g]", "f");
  const auto attitude = attitudes.read("0,10,-5,30,1");
  EXPECT_NEAR(attitude->setpoint.specific_thrust, 9.80665, 1e-12);
  const Vector3d euler = control::euler_angles(attitude->setpoint.q_ned_from_frd).vector();
  EXPECT_LT((euler * 180.0 / M_PI - Vector3d(10, -5, 30)).norm(), 1e-9);
}

TEST(SetpointRows, AssumeEnuPositionsWithoutUnits) {
  SetpointRows rows("t,x,y,z,yaw", "f");
  ASSERT_TRUE(rows.assumption());
  EXPECT_NE(rows.assumption()->find("in ENU"), std::string::npos);
  const auto row = rows.read("0,1,2,3,0");
  EXPECT_EQ(row->setpoint.position_ned, Vector3d(2, 1, -3));
  EXPECT_NEAR(row->setpoint.yaw_rad, M_PI / 2, 1e-12) << "east";
  EXPECT_NE(refusal("t,vx,vy,vz").find("has no units, must have them"), std::string::npos);
}

TEST(SetpointRows, RefuseInvalidColumnsAndRows) {
  EXPECT_EQ(refusal("t [s],x [m],y [m]"),
            "s.csv:1: header: has no column z [m], must have x [m], y [m] and z [m]");
  EXPECT_EQ(refusal("x [m],y [m],z [m]"), "s.csv:1: header: has no column t [s], must have t [s]");
  EXPECT_EQ(refusal("t [s],x [ft],y [m],z [m]"),
            "s.csv:1: header: has the column x [ft] with an unknown unit, must be x [m] or x [cm] or "
            "x [mm]");
  EXPECT_EQ(refusal("t [s],x,y [m],z [m]"),
            "s.csv:1: header: has the column x without a unit, must be x [m] or x [cm] or x [mm]");
  EXPECT_EQ(refusal("t [s],x [m],y [m],z [m],roll [rad]"),
            "s.csv:1: header: has the column roll [rad], which a stream of positions does not use");
  EXPECT_EQ(refusal("t [s],x [m],x [m],y [m],z [m]"),
            "s.csv:1: header: has the column x twice, must have it once");
  EXPECT_NE(refusal("t [s],height [m]").find("has the column height [m], must be t [s], x [m]"),
            std::string::npos);
  EXPECT_NE(refusal("t [s]").find("names no setpoint"), std::string::npos);
  const std::string header = "t [s],x [m],y [m],z [m]";
  EXPECT_EQ(refusal(header, {"0,0,0,-1", "0,0,0,-1"}),
            "s.csv:3: t: is 0 s, must be above that of the previous row, 0 s");
  EXPECT_EQ(refusal(header, {"0,0,0"}), "s.csv:2: row: has 3 fields, must have 4");
  for (const char* text : {"nan", "inf", "up", ""})
    EXPECT_EQ(refusal(header, {std::string("0,") + text + ",0,-1"}),
              std::string("s.csv:2: x [m]: is '") + text + "', must be a finite number");
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

}  // namespace
}  // namespace swiftlet::ground
