// The desired motion of the vehicle at one instant.
#pragma once

#include <Eigen/Core>

namespace swiftlet::control {

struct Reference {
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();      // m
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();      // m/s
  Eigen::Vector3d acceleration_ned = Eigen::Vector3d::Zero();  // m/s^2
  Eigen::Vector3d jerk_ned = Eigen::Vector3d::Zero();          // m/s^3
  Eigen::Vector3d snap_ned = Eigen::Vector3d::Zero();          // m/s^4
  double yaw_rad = 0.0;
  double yaw_rate = 0.0;          // rad/s
  double yaw_acceleration = 0.0;  // rad/s^2
};

}  // namespace swiftlet::control
