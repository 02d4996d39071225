#include "swiftlet/ground/ros/requests.hpp"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/record/file/cdr_writer.hpp"

namespace swiftlet::ros::requests_test {

constexpr double kQuarterTurn = 1.5707963267948966;

Bytes pose(const std::string& frame, const Eigen::Vector3d& enu, double yaw_enu, double length = 1.0) {
  record::CdrWriter out;
  out.put(std::int32_t{12}).put(std::uint32_t{34}).text(frame);
  out.put(enu.x()).put(enu.y()).put(enu.z());
  out.put(0.0).put(0.0).put(length * std::sin(yaw_enu / 2.0)).put(length * std::cos(yaw_enu / 2.0));
  return out.take();
}

Bytes twist(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) {
  record::CdrWriter out;
  for (const Eigen::Vector3d& v : {linear, angular}) out.put(v.x()).put(v.y()).put(v.z());
  return out.take();
}

TEST(RosGoal, IsTurnedFromEnuToNed) {
  std::string refusal;
  for (const char* frame : {"map", "", "map"}) {
    const auto goal = goal_of(pose(frame, {1.0, 2.0, 3.0}, 0.0), -0.5, refusal);
    ASSERT_TRUE(goal) << refusal;
    EXPECT_EQ(goal->position_ned_m, Eigen::Vector3d(2.0, 1.0, -3.0));
    EXPECT_NEAR(goal->yaw_rad, kQuarterTurn, 1e-12) << "faces east";
  }
  EXPECT_NEAR(goal_of(pose("map", {0, 0, 1}, kQuarterTurn), 0.0, refusal)->yaw_rad, 0.0, 1e-12)
      << "faces north";
}

TEST(RosGoal, WithoutAHeightKeepsThePresentOne) {
  std::string refusal;
  const auto goal = goal_of(pose("map", {1.0, 2.0, 0.0}, 0.0), -0.7, refusal);
  ASSERT_TRUE(goal) << refusal;
  EXPECT_EQ(goal->position_ned_m.z(), -0.7);
}

TEST(RosGoal, RefusesWhatIsNoPoseInTheMap) {
  const auto expect_refusal = [](const Bytes& payload, const std::string& sentence) {
    std::string refusal;
    EXPECT_FALSE(goal_of(payload, 0.0, refusal));
    EXPECT_EQ(refusal, sentence);
  };
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  expect_refusal(pose("base_link", {1, 2, 3}, 0.0), "its frame is 'base_link', must be map");
  expect_refusal(pose("map", {1, kInfinite, 3}, 0.0), "its position is not finite");
  expect_refusal(pose("map", {1, 2, 3}, 0.0, 0.5), "its orientation is no unit quaternion");
  std::string unknown;
  EXPECT_FALSE(goal_of(pose("map", {1, 2, 0}, 0.0), std::nan(""), unknown));
  EXPECT_EQ(unknown, "it has no height, and that of the vehicle is not known yet");
  EXPECT_TRUE(goal_of(pose("map", {1, 2, 3}, 0.0), std::nan(""), unknown)) << unknown;
  Bytes whole = pose("map", {1, 2, 3}, 0.0);
  for (std::size_t size = 0; size < whole.size(); ++size)
    expect_refusal(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)),
                   "it is no geometry_msgs/PoseStamped");
  whole[1] = 7;  // XCDR2
  expect_refusal(whole, "it is no geometry_msgs/PoseStamped");
}

TEST(RosVelocity, IsTurnedByTheHeading) {
  std::string refusal;
  const auto setpoint = velocity_of(twist({1.0, 0.0, 0.5}, {0, 0, 0.2}), kQuarterTurn, refusal);
  ASSERT_TRUE(setpoint) << refusal;
  EXPECT_TRUE(setpoint->velocity_ned_m_s.isApprox(Eigen::Vector3d(0.0, 1.0, -0.5), 1e-12)) << "east and up";
  EXPECT_EQ(setpoint->heading.yaw_rate_rad_s, -0.2);
  EXPECT_FALSE(setpoint->heading.yaw_rad);
  const auto left = velocity_of(twist({0.0, 1.0, 0.0}, {0, 0, 0}), 0.0, refusal);
  ASSERT_TRUE(left) << refusal;
  EXPECT_TRUE(left->velocity_ned_m_s.isApprox(Eigen::Vector3d(0.0, -1.0, 0.0), 1e-12)) << "west";
}

TEST(RosVelocity, RefusesWhatAVehicleCannotFly) {
  std::string refusal;
  EXPECT_FALSE(velocity_of(twist({std::nan(""), 0, 0}, {0, 0, 0}), 0.0, refusal));
  EXPECT_EQ(refusal, "it is not finite");
  EXPECT_FALSE(velocity_of(twist({1, 0, 0}, {0.1, 0, 0}), 0.0, refusal));
  EXPECT_EQ(refusal, "its roll or pitch rate is not 0");
  EXPECT_FALSE(velocity_of(twist({1, 0, 0}, {0, 0, 0}), std::nan(""), refusal));
  EXPECT_EQ(refusal, "the heading of the vehicle is not known yet");
  EXPECT_FALSE(velocity_of({}, 0.0, refusal));
  EXPECT_EQ(refusal, "it is no geometry_msgs/Twist");
}

}  // namespace swiftlet::ros::requests_test
