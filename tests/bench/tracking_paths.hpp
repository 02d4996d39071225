// The paths whose tracking error is measured.
#pragma once

#include <functional>
#include <string>

#include <Eigen/Core>

#include "swiftlet/control/types/polynomial.hpp"

namespace swiftlet::bench {

constexpr double kHeight = 1.0;  // m

// A path: desired positions, and the trajectory commanded for it.
struct Path {
  std::string name;
  std::function<Eigen::Vector3d(double)> position_ned;  // at a time from the trajectory's start, s
  control::Trajectory trajectory;
  double score_from_s = 0.0;
  double score_to_s = 0.0;
};

// Sides at constant speed with velocity steps at the corners. The trajectory smooths each step within kBlend
// before and after it, since a vehicle cannot follow a step.
Path square(const std::string& name, double length);
Path minimum_jerk_square();
// Laps of a Crazyswarm trajectory file: duration, then eight coefficients each of x, y, z and yaw, in ENU.
Path figure_of_eight(const std::string& file, int laps);
// x = 2 sin(w t), y = sin(2 w t), 10 s per lap, as polynomials of degree 7 over 0.5 s, after 10 s of
// acceleration from rest.
Path lemniscate();
Path faster(const Path& path, double factor);
Eigen::Vector3d reference_at(const control::Trajectory& trajectory, double t);

}  // namespace swiftlet::bench
