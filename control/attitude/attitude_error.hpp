// How far the attitude is from the one that is asked for: by the paper's Euler angles, or by the rotation
// itself. Both are about the body's axes and alike to first order.
//
// What is asked for is where the body z axis points, for that is where the thrust goes, and the Euler yaw.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/math/heading.hpp"

namespace swiftlet::control {

// Of the angle between the body z axis and straight down: 1 upright, -1 upside down.
inline double cosine_of_tilt(const Eigen::Quaterniond& q_ned_from_frd) {
  const Eigen::Quaterniond& q = q_ned_from_frd;
  return 1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y());
}

// The body z axis in NED: third column of the rotation matrix.
inline Eigen::Vector3d body_z(const Eigen::Quaterniond& q_ned_from_frd) {
  const Eigen::Quaterniond& q = q_ned_from_frd;
  return {2.0 * (q.x() * q.z() + q.w() * q.y()), 2.0 * (q.y() * q.z() - q.w() * q.x()), cosine_of_tilt(q)};
}

// The body's axes, as columns in NED, of the attitude whose z axis is body_z_ned, of unit length and less
// than 90 degrees from straight down, and whose Euler yaw, Eq. (3), is the heading.
Eigen::Matrix3d attitude_along(const Eigen::Vector3d& body_z_ned, const Heading& heading);

// The differences of the Euler angles (phi, theta, psi), each in -pi .. pi. phi and theta point body z along
// body_z_ned at the present yaw, so that the thrust points right while yaw is still turning:
//   b = R_z(psi)' body_z_ned, phi_c = -asin b_y, theta_c = atan2(b_x, b_z).
// Finite at every attitude, but phi and psi jump at theta = +-90 degrees: good for tilts up to about 80.
Eigen::Vector3d euler_error(const Eigen::Quaterniond& q_ned_from_frd, const Eigen::Vector3d& body_z_ned,
                            double yaw_rad);

struct RotationError {
  Eigen::Vector3d angle = Eigen::Vector3d::Zero();  // about the body's axes, as below
  Eigen::Matrix3d r_frd_from_reference = Eigen::Matrix3d::Identity();
};

// The rotation that is missing, in two parts that follow each other: the shortest one that brings body z to
// where it should be, then one about z for yaw (Brescianini, Hehn, D'Andrea, "Nonlinear quadrocopter attitude
// control", ETH 2013). Each counts as 2 sin(angle / 2) about its axis: the angle when it is small, at most 2,
// and never without a way to go: upside down it turns about the body's x axis.
RotationError rotation_error(const Eigen::Quaterniond& q_ned_from_frd, const Eigen::Vector3d& body_z_ned,
                             const Heading& heading);

}  // namespace swiftlet::control
