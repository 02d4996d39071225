// Splines of least jerk or least snap through points at given times, in time that grows with the number of
// points: the unknowns are the derivatives at the points (Richter, Bry and Roy, "Polynomial Trajectory
// Planning for Aggressive Quadrotor Flight in Dense Indoor Environments", ISRR 2013), of which each is tied
// to its neighbours alone: a block-tridiagonal system.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "swiftlet/control/types/polynomial.hpp"

namespace swiftlet::control {

// What a spline has the least integral of, squared. Derivatives up to one order less are continuous at the
// points, and up to two orders more inside them.
enum class Smoothness { kMinimumJerk, kMinimumSnap };

using PositionYaw = Eigen::Vector4d;  // north, east, down in m and yaw in rad

// Velocity, acceleration and jerk of a place, as columns. kMinimumJerk does not look at the jerk.
using PlaceDerivatives = Eigen::Matrix<double, 4, 3>;

// One segment for each duration, from points[i] to points[i + 1]; two points or more, durations above 0.
// The derivatives are those at the first and the last point; zero is rest.
std::vector<PolynomialSegment> spline(Smoothness smoothness, const std::vector<PositionYaw>& points,
                                      const std::vector<double>& durations_s,
                                      const PlaceDerivatives& at_start = PlaceDerivatives::Zero(),
                                      const PlaceDerivatives& at_end = PlaceDerivatives::Zero());

}  // namespace swiftlet::control
