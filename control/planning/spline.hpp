// Splines of minimum jerk or minimum snap through points at given times, in time linear in the number of
// points. The unknowns are the derivatives at the points (Richter, Bry and Roy, "Polynomial Trajectory
// Planning for Aggressive Quadrotor Flight in Dense Indoor Environments", ISRR 2013). Each couples to its
// neighbours only, so the system is block-tridiagonal.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "swiftlet/control/types/polynomial.hpp"

namespace swiftlet::control {

// The derivative whose squared integral is minimal: order 3 or 4. At the points, derivatives of up to one
// order less are continuous by construction; at interior points those of order up to 4 or 6 are, by
// optimality.
enum class Smoothness { kMinimumJerk, kMinimumSnap };

using PositionYaw = Eigen::Vector4d;  // north, east, down in m and yaw in rad

// Velocity, acceleration and jerk at a point, as columns. kMinimumJerk ignores the jerk.
using PlaceDerivatives = Eigen::Matrix<double, 4, 3>;

// One segment per duration, from points[i] to points[i + 1]. Needs two points or more and durations above 0.
// at_start and at_end are the derivatives at the first and the last point; zero is rest.
std::vector<PolynomialSegment> spline(Smoothness smoothness, const std::vector<PositionYaw>& points,
                                      const std::vector<double>& durations_s,
                                      const PlaceDerivatives& at_start = PlaceDerivatives::Zero(),
                                      const PlaceDerivatives& at_end = PlaceDerivatives::Zero());

}  // namespace swiftlet::control
