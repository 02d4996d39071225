#include "swiftlet/ground/teleop/sticks.hpp"

#include <algorithm>

namespace swiftlet::ground {

VelocitySetpoint velocity_of(const Sticks& sticks, const TeleopLimits& limits, double yaw_rad) {
  Eigen::Vector2d level(sticks.forward, sticks.right);
  level *= limits.horizontal_m_s / std::max(level.norm(), 1.0);
  const Eigen::Vector2d north_east = Eigen::Rotation2Dd(yaw_rad) * level;
  VelocitySetpoint setpoint;
  setpoint.velocity_ned_m_s = {north_east.x(), north_east.y(), -sticks.up * limits.vertical_m_s};
  setpoint.heading.yaw_rate_rad_s = sticks.turn * limits.yaw_rate_rad_s;
  return setpoint;
}

}  // namespace swiftlet::ground
