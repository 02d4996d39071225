// The attitude error, by the paper's Euler angles or by the rotation itself. Both are about the body axes
// and equal to first order.
//
// The desired attitude is the direction of body z, which is the direction of thrust, and the Euler yaw.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/math/heading.hpp"

namespace swiftlet::control {

// Cosine of the angle between body z and straight down: 1 upright, -1 upside down.
inline double cosine_of_tilt(const Eigen::Quaterniond& q_ned_from_frd) {
  const Eigen::Quaterniond& q = q_ned_from_frd;
  return 1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y());
}

// The body z axis in NED: third column of the rotation matrix.
inline Eigen::Vector3d body_z(const Eigen::Quaterniond& q_ned_from_frd) {
  const Eigen::Quaterniond& q = q_ned_from_frd;
  return {2.0 * (q.x() * q.z() + q.w() * q.y()), 2.0 * (q.y() * q.z() - q.w() * q.x()), cosine_of_tilt(q)};
}

// The body axes, as columns in NED, of the attitude whose z axis is body_z_ned (unit length, less than 90
// degrees from straight down) and whose Euler yaw, Eq. (3), is the heading.
Eigen::Matrix3d attitude_along(const Eigen::Vector3d& body_z_ned, const math::Heading& heading);

// Differences of the Euler angles (phi, theta, psi), each in -pi .. pi. The desired phi and theta point body
// z along body_z_ned at the present yaw, so the thrust direction is right while yaw still turns:
//   b = R_z(psi)' body_z_ned, phi_c = -asin b_y, theta_c = atan2(b_x, b_z).
// Finite at every attitude, but phi and psi jump at theta = +-90 degrees: usable for tilts up to about 80
// degrees.
Eigen::Vector3d euler_error(const Eigen::Quaterniond& q_ned_from_frd, const Eigen::Vector3d& body_z_ned,
                            double yaw_rad);

struct RotationError {
  Eigen::Vector3d angle = Eigen::Vector3d::Zero();  // about the body axes, as below
  Eigen::Matrix3d r_frd_from_reference = Eigen::Matrix3d::Identity();
};

// The rotation to the desired attitude, in two successive parts: the shortest one that brings body z to its
// desired direction, then one about z for yaw (Brescianini, Hehn, D'Andrea, "Nonlinear quadrocopter attitude
// control", ETH 2013). Each is 2 sin(angle / 2) about its axis: equal to the angle if small, at most 2, and
// never without a direction: upside down it turns about the body x axis.
RotationError rotation_error(const Eigen::Quaterniond& q_ned_from_frd, const Eigen::Vector3d& body_z_ned,
                             const math::Heading& heading);

}  // namespace swiftlet::control
