// Straight legs from rest to rest in the least time that speed, acceleration and jerk allow: seven pieces of
// constant jerk (Biagiotti and Melchiorri, "Trajectory Planning for Automatic Machines and Robots", 2008,
// section 3.4).
#pragma once

#include <vector>

#include "swiftlet/control/types/polynomial.hpp"

namespace swiftlet::control {

// All above 0.
struct MotionLimits {
  double speed = 2.0;         // m/s, of the velocity's length
  double acceleration = 2.0;  // m/s^2, likewise
  double jerk = 20.0;         // m/s^3, likewise
  double yaw_rate = 1.5;      // rad/s
};

// Up to seven segments; none if both places and yaws are the same. The yaw turns in step with the way; where
// there is no way to go, it turns by minimum jerk.
std::vector<PolynomialSegment> limited_jerk_leg(const Eigen::Vector3d& from_ned, double from_yaw,
                                                const Eigen::Vector3d& to_ned, double to_yaw,
                                                const MotionLimits& limits);

}  // namespace swiftlet::control
