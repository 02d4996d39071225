// The distance of two vehicles, measured by ellipsoids that are higher than wide, because a rotor's downwash reaches
// further below it than to its sides: J. A. Preiss, W. Hoenig, G. S. Sukhatme, N. Ayanian, "Crazyswarm: A large
// nano-quadcopter swarm", ICRA 2017, section V.
#pragma once

#include <Eigen/Core>

#include "swiftlet/ground/fleet/flight_path.hpp"

namespace swiftlet::ground {

// About a vehicle's centre. Two vehicles are apart while their ellipsoids do not touch.
struct Ellipsoid {
  double radius_xy_m = 0.15;  // > 0
  double radius_z_m = 0.3;    // > 0
};

// 1: the ellipsoids of two vehicles touch; 0: both are at one place. Along a line it grows with the distance.
double clearance(const Ellipsoid& a, const Ellipsoid& b, const Eigen::Vector3d& from_a_to_b_m);

struct Approach {
  // The least of the flight, or a lower bound of it: near 1 at most 1e-5 below it, near 0 at most 0.004.
  double clearance = 0.0;
  double time_s = 0.0;                              // since the start, when it is least
  Eigen::Vector3d a_ned = Eigen::Vector3d::Zero();  // m, where the two are then
  Eigen::Vector3d b_ned = Eigen::Vector3d::Zero();
};

// The least clearance over all times from the common start until both have ended, and therefore ever after. It is bounded
// between the polynomials' Bernstein coefficients, not sampled: no approach, however short, is missed.
Approach closest_approach(const FlightPath& a, const Ellipsoid& around_a, const FlightPath& b,
                          const Ellipsoid& around_b);

}  // namespace swiftlet::ground
