// Time-optimal straight legs from rest to rest under limits of speed, acceleration and jerk: seven pieces of
// constant jerk (Biagiotti and Melchiorri, "Trajectory Planning for Automatic Machines and Robots", 2008,
// section 3.4).
#pragma once

#include <vector>

#include "swiftlet/control/types/polynomial.hpp"

namespace swiftlet::control {

// All above 0.
struct MotionLimits {
  double speed = 2.0;         // m/s, length of the velocity
  double acceleration = 2.0;  // m/s^2, likewise
  double jerk = 20.0;         // m/s^3, likewise
  double yaw_rate = 1.5;      // rad/s
};

// Up to seven segments; none if both positions and yaws are equal. Yaw turns in proportion to the distance
// covered. With equal positions it turns by minimum jerk.
std::vector<PolynomialSegment> limited_jerk_leg(const Eigen::Vector3d& from_ned, double from_yaw,
                                                const Eigen::Vector3d& to_ned, double to_yaw,
                                                const MotionLimits& limits);

}  // namespace swiftlet::control
