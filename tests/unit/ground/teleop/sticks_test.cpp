#include "swiftlet/ground/teleop/sticks.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace swiftlet::ground::sticks_test {

const TeleopLimits kLimits{0.5, 0.3, 0.8};

TEST(Sticks, MoveAsSeenFromTheVehicle) {
  const Sticks ahead{1.0, 0.0, 0.0, 0.0};
  EXPECT_TRUE(velocity_of(ahead, kLimits, 0.0).velocity_ned_m_s.isApprox(Eigen::Vector3d(0.5, 0.0, 0.0)));
  const Eigen::Vector3d east(0.0, 0.5, 0.0);
  EXPECT_LT((velocity_of(ahead, kLimits, M_PI / 2).velocity_ned_m_s - east).norm(), 1e-12);
  const Sticks right{0.0, 1.0, 0.0, 0.0};
  EXPECT_LT((velocity_of(right, kLimits, 0.0).velocity_ned_m_s - east).norm(), 1e-12);
  const Eigen::Vector3d south(-0.5, 0.0, 0.0);
  EXPECT_LT((velocity_of(right, kLimits, M_PI / 2).velocity_ned_m_s - south).norm(), 1e-12);
}

TEST(Sticks, UpIsNegativeInNedAndRightTurnsTowardsEast) {
  const VelocitySetpoint setpoint = velocity_of({0.0, 0.0, 1.0, 0.5}, kLimits, 0.3);
  EXPECT_EQ(setpoint.velocity_ned_m_s, Eigen::Vector3d(0.0, 0.0, -0.3));
  EXPECT_DOUBLE_EQ(setpoint.heading.yaw_rate_rad_s, 0.4);
  EXPECT_FALSE(setpoint.heading.yaw_rad);
}

TEST(Sticks, KeepTheSpeedLimitInAnyDirection) {
  for (double yaw = -3.0; yaw < 3.0; yaw += 0.5) {
    const Eigen::Vector3d diagonal = velocity_of({1.0, -1.0, 0.0, 0.0}, kLimits, yaw).velocity_ned_m_s;
    EXPECT_NEAR(diagonal.norm(), 0.5, 1e-12);
    const Eigen::Vector3d part = velocity_of({0.3, 0.4, 0.0, 0.0}, kLimits, yaw).velocity_ned_m_s;
    EXPECT_NEAR(part.norm(), 0.25, 1e-12);
  }
}

}  // namespace swiftlet::ground::sticks_test
