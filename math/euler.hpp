// The paper's Euler angles, Eq. (3): yaw psi, then pitch theta, then roll phi.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/math/heading.hpp"

namespace swiftlet::math {

struct EulerAngles {
  double roll_rad = 0.0;   // phi, -pi .. pi
  double pitch_rad = 0.0;  // theta, -pi/2 .. pi/2
  Heading heading;         // psi, -pi .. pi

  // (phi, theta, psi)
  Eigen::Vector3d vector() const { return {roll_rad, pitch_rad, heading.yaw_rad}; }
};

// Euler angles of a unit quaternion, Eq. (3). At theta = +-pi/2 only the sum or difference of phi and psi is
// defined; psi is set to 0.
EulerAngles euler_angles(const Eigen::Quaterniond& q_ned_from_frd);
// Unit quaternion q_ned_from_frd of the Euler angles (phi, theta, psi), rad.
Eigen::Quaterniond quaternion_from_euler(const Eigen::Vector3d& euler_rad);

// Wraps an angle to -pi .. pi.
double wrap_angle(double angle_rad);

}  // namespace swiftlet::math
