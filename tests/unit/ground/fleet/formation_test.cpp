#include "swiftlet/ground/fleet/formation.hpp"

#include <gtest/gtest.h>

namespace swiftlet::ground::formation_test {

using Eigen::Vector3d;

const Ellipsoid kSafety{0.15, 0.3};

FormationVehicle flying(const char* name, const Vector3d& at, bool is_member = true) {
  return {name, at, true, is_member};
}

TEST(Formation, MovesItsCentreAndKeepsItsOffsets) {
  const std::vector<FormationVehicle> vehicles = {
      flying("a", {0, 0, -1}), flying("b", {2, 0, -1.5}), {"c", {5, 5, 0}, false, false}};
  const std::vector<Vector3d> targets = formation_targets(vehicles, {0, 1, -2});
  EXPECT_LT((targets[0] - Vector3d(-1, 1, -1.75)).norm(), 1e-12);
  EXPECT_LT((targets[1] - Vector3d(1, 1, -2.25)).norm(), 1e-12);
  EXPECT_EQ(targets[2], vehicles[2].position_ned) << "it stays";
  EXPECT_EQ(formation_refusal(vehicles, targets, {}, kSafety), "");
}

std::string refusal(const std::vector<FormationVehicle>& vehicles, const Vector3d& centre, double speed = 0.5,
                    double skew_s = 0.3, const control::Limits& limits = {}) {
  return formation_refusal(vehicles, formation_targets(vehicles, centre), {speed, limits, skew_s}, kSafety);
}

TEST(Formation, RefusesAWayNearToOthers) {
  const FormationVehicle a = flying("a", {0, 0, -1}), b = flying("b", {0, 1, -1});
  EXPECT_EQ(refusal({a, b, flying("c", {1, 0.2, -1}, false)}, {2, 0.5, -1}),
            "a would come too near to c: 0.20 m across and 0.00 m in height, at (1.00, 0.00, -1.00) m NED; "
            "they must be 0.30 m "
            "apart across, or 0.60 m in height");
  EXPECT_EQ(refusal({a, b, flying("c", {1, 0.5, -1}, false)}, {2, 0.5, -1}), "") << "between the two";
  EXPECT_NE(
      refusal({a, b, {"c", {1, 0, 0}, false, false}}, {1, 0.5, -0.5}).find("a would come too near to c"),
      std::string::npos)
      << "one that stands";
  EXPECT_EQ(refusal({a, b, {"c", {1, 0, 0}, false, false}}, {1, 0.5, -0.7}), "");
}

// Behind each other at 0.5 m, one that begins 0.3 s later is up to 0.3 m further behind or nearer at 1 m/s.
TEST(Formation, LeavesRoomForOneThatBeginsLater) {
  const std::vector<FormationVehicle> vehicles = {flying("a", {0, 0, -1}), flying("b", {0.5, 0, -1})};
  EXPECT_EQ(refusal(vehicles, {3, 0, -1}, 0.5), "");
  EXPECT_NE(refusal(vehicles, {3, 0, -1}, 1.0).find("too near"), std::string::npos);
  EXPECT_EQ(refusal(vehicles, {0.25, 3, -1}, 1.0), "") << "beside each other";
  EXPECT_EQ(refusal(vehicles, {3, 0, -1}, 1.0, 0.1), "");
  EXPECT_NE(refusal(vehicles, {3, 0, -1}, 0.5, 0.6).find("too near"), std::string::npos);
}

// The later an answer may come, the fewer moves have to be taken back.
TEST(Formation, AllowsTheLongestSkewThatKeepsTheWaysApart) {
  const std::vector<FormationVehicle> vehicles = {flying("a", {0, 0, -1}), flying("b", {0.5, 0, -1})};
  const auto longest = [&](const Vector3d& centre) {
    return longest_skew_s(vehicles, formation_targets(vehicles, centre), {0.5, {}, 0.2}, kSafety, 5.0);
  };
  EXPECT_EQ(longest({0.25, 3, -1}), 5.0) << "beside each other";
  // Behind each other, 0.2 m are left, which one flies in 0.4 s at its peak speed.
  const double behind_s = longest({3, 0, -1});
  EXPECT_GT(behind_s, 0.4 - 0.01) << "the step of the search";
  EXPECT_LT(behind_s, 0.41);
  EXPECT_EQ(refusal(vehicles, {3, 0, -1}, 0.5, behind_s), "");
  EXPECT_NE(refusal(vehicles, {3, 0, -1}, 0.5, behind_s + 0.02), "");
}

// The vehicles' limits decide how long the move takes, and so how far one is ahead of another that begins later.
TEST(Formation, MovesWithinTheLimitsOfTheVehicles) {
  const std::vector<FormationVehicle> vehicles = {flying("a", {0, 0, -1}), flying("b", {0.5, 0, -1})};
  control::Limits slow;
  slow.max_reference_acceleration = 0.2;
  EXPECT_NE(refusal(vehicles, {3, 0, -1}, 1.0).find("too near"), std::string::npos);
  EXPECT_EQ(refusal(vehicles, {3, 0, -1}, 1.0, 0.3, slow), "");
}

TEST(Formation, RefusesOneThatIsTooNearAlready) {
  EXPECT_NE(refusal({flying("a", {0, 0, -1}), flying("b", {0.2, 0, -1})}, {1, 1, -1}).find("too near"),
            std::string::npos);
}

TEST(Formation, LandsNobodyOnAnother) {
  const auto obstacles = landing_obstacles({flying("a", {0, 0, -1}),
                                            flying("b", {0.1, 0, -2}),
                                            flying("c", {1, 0, -1}),
                                            {"d", {1.1, 0.1, 0}, false, false},
                                            flying("e", {1, 0.4, -2})},
                                           kSafety);
  EXPECT_FALSE(obstacles[0]) << "the lower one";
  EXPECT_EQ(obstacles[1], 0U);
  EXPECT_EQ(obstacles[2], 3U) << "it stands there";
  EXPECT_FALSE(obstacles[3]);
  EXPECT_FALSE(obstacles[4]) << "0.4 m beside";
}

}  // namespace swiftlet::ground::formation_test
