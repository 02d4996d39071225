// The reasons for which missions and trajectories are refused.
#include "swiftlet/control/planning/checks.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/types/polynomial.hpp"

namespace swiftlet::control::checks_test {

TEST(PlanChecks, RefuseMissionsWithItemValueAndLimit) {
  const Limits limits;
  Mission mission;
  EXPECT_FALSE(check(mission, limits).accepted);
  const MissionItem good{MissionItemKind::kWaypoint, {1, 0, -1}, 0, true, 0.5, 0.0};
  const auto reason_of = [&](const MissionItem& item) {
    mission.items = {good, item, good};
    return std::string(check(mission, limits).reason);
  };
  MissionItem bad = good;
  bad.position_ned.x() = 7.0;
  EXPECT_NE(reason_of(bad).find("item 2: x is 7.000 m, outside the fence"), std::string::npos);
  bad = good;
  bad.speed = 9.0;
  EXPECT_NE(reason_of(bad).find("item 2: speed is 9.000 m/s"), std::string::npos);
  bad = good;
  bad.hold_s = -1.0;
  EXPECT_NE(reason_of(bad).find("item 2: hold"), std::string::npos);
  bad = good;
  bad.yaw_free = false;
  bad.yaw_rad = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(reason_of(bad).find("item 2: yaw"), std::string::npos);
  bad = good;
  bad.kind = MissionItemKind::kLand;
  EXPECT_NE(reason_of(bad).find("last item"), std::string::npos);
  bad.kind = MissionItemKind::kTakeoff;
  EXPECT_NE(reason_of(bad).find("first item"), std::string::npos);
  mission.items.assign(kMaxMissionItems, good);
  EXPECT_TRUE(check(mission, limits).accepted);
  mission.items.push_back(good);
  EXPECT_NE(std::string(check(mission, limits).reason).find("2049 items"), std::string::npos);
}

TEST(PlanChecks, RefuseDiscontinuousOutsideOrFastTrajectories) {
  const Limits limits;
  Trajectory trajectory;
  EXPECT_FALSE(check(trajectory, limits).accepted);
  trajectory.segments = {minimum_jerk({0, 0, -1}, 0, {1, 0, -1}, 0, 3.0),
                         minimum_jerk({1.1, 0, -1}, 0, {0, 0, -1}, 0, 3.0)};
  EXPECT_NE(std::string(check(trajectory, limits).reason).find("segment 2 does not start"),
            std::string::npos);
  trajectory.segments = {minimum_jerk({0, 0, -1}, 0, {8, 0, -1}, 0, 30.0)};
  EXPECT_NE(std::string(check(trajectory, limits).reason).find("outside the fence"), std::string::npos);
  trajectory.segments = {minimum_jerk({0, 0, -1}, 0, {2, 0, -1}, 0, 1.6)};
  EXPECT_NE(std::string(check(trajectory, limits).reason).find("m/s, the limit"), std::string::npos);
  trajectory.segments = {minimum_jerk({0, 0, -1}, 0, {2, 0, -1}, 0, 5.0)};
  trajectory.segments[0].y[3] = std::numeric_limits<double>::infinity();
  EXPECT_NE(std::string(check(trajectory, limits).reason).find("not a finite"), std::string::npos);
  trajectory.segments[0].y[3] = 0.0;
  trajectory.segments[0].duration_s = 0.0;
  EXPECT_NE(std::string(check(trajectory, limits).reason).find("duration"), std::string::npos);
}

}  // namespace swiftlet::control::checks_test
