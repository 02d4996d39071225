// Polynomial references: the segments of missions and trajectories.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "swiftlet/control/types/reference.hpp"

namespace swiftlet::control {

constexpr int kPolynomialCoefficients = 8;  // up to t^7: minimum snap between full boundary conditions

// c[0] + c[1] t + ... + c[7] t^7, t in s from the segment's start.
using Polynomial = std::array<double, kPolynomialCoefficients>;

struct PolynomialSegment {
  double duration_s = 0.0;          // > 0
  Polynomial x{}, y{}, z{}, yaw{};  // m in NED, rad
};

struct Trajectory {
  std::uint64_t id = 0;
  std::vector<PolynomialSegment> segments;
};

constexpr int kMaxTrajectorySegments = 1024;

// The reference at time t_s of the segment; t_s is clamped to 0 .. duration_s.
Reference evaluate(const PolynomialSegment& segment, double t_s);

// The same path, `factor` times as slow, > 0.
PolynomialSegment stretched(const PolynomialSegment& segment, double factor);

// Rest to rest along a straight line, minimum jerk (Flash and Hogan 1985): 10 s^3 - 15 s^4 + 6 s^5.
// duration_s > 0.
PolynomialSegment minimum_jerk(const Eigen::Vector3d& from_ned, double from_yaw,
                               const Eigen::Vector3d& to_ned, double to_yaw, double duration_s);

// The quintic from value, first and second derivative to `to`, where both derivatives are zero, after
// duration_s > 0.
Polynomial quintic_to_rest(double value, double first, double second, double to, double duration_s);

// The quintic that leaves `from` with its position, velocity and acceleration and is at rest at `to_ned`,
// `to_yaw` after duration_s > 0.
PolynomialSegment join_to_rest(const Reference& from, const Eigen::Vector3d& to_ned, double to_yaw,
                               double duration_s);

// The septic between two references: it has position, velocity, acceleration and jerk of both, and takes
// duration_s > 0. The same holds for yaw, whose jerk is zero at both ends.
PolynomialSegment join(const Reference& from, const Reference& to, double duration_s);

// The shortest duration for which a minimum-jerk move over `distance` (>= 0) stays within peak speed,
// acceleration and jerk (all > 0). 15/8 d/T is the peak speed, 10/sqrt(3) d/T^2 the peak acceleration, 60
// d/T^3 the peak jerk. At least min_duration_s.
double minimum_jerk_duration(double distance, double peak_speed, double peak_acceleration, double peak_jerk,
                             double min_duration_s = 0.1);

// The same for the septic from rest to rest of join(): 35/16 d/T, 84/25 sqrt(5) d/T^2, 105/2 d/T^3.
double septic_duration(double distance, double peak_speed, double peak_acceleration, double peak_jerk,
                       double min_duration_s = 0.1);

}  // namespace swiftlet::control
