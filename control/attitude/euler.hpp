// The paper's Euler angles, Eq. (3): yaw psi, then pitch theta, then roll phi.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace swiftlet::control {

// (phi, theta, psi) of Eq. (3): phi and psi in -pi .. pi, theta in -pi/2 .. pi/2. At theta = +-pi/2, where
// phi and psi are one angle, psi is 0.
Eigen::Vector3d euler_from_quaternion(const Eigen::Quaterniond& q_ned_from_frd);
Eigen::Quaterniond quaternion_from_euler(const Eigen::Vector3d& euler_rad);

// The same angle in -pi .. pi.
double wrap_angle(double angle_rad);

}  // namespace swiftlet::control
