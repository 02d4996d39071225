// Between the loops: the acceleration that the outer loop wants becomes a thrust and its direction, and the
// derivatives of a smooth reference become the body rates and accelerations that go with it (differential
// flatness).
#pragma once

#include <Eigen/Core>

#include "swiftlet/control/types/reference.hpp"
#include "swiftlet/math/heading.hpp"

namespace swiftlet::control {

struct ThrustAttitude {
  double thrust_n = 0.0;                                  // > 0
  Eigen::Vector3d body_z_ned = Eigen::Vector3d::UnitZ();  // unit length; the thrust acts against it
  bool limited = false;                                   // not the acceleration that was asked for
};

// The least upward specific force that is asked of the rotors, as a part of g: no acceleration command makes
// the vehicle fall faster than 0.9 g or turn over.
constexpr double kMinimumLift = 0.1;

// b = g e3 - a, thrust = m |b|, body z along b. The vertical part comes first: b_z is kept (at least
// kMinimumLift g), and b_x and b_y are shortened until the tilt is at most the angle of max_tilt_tangent. An
// acceleration that is not finite counts as 0 and is marked as limited.
ThrustAttitude thrust_attitude(double mass_kg, const Eigen::Vector3d& acceleration_ned,
                               double max_tilt_tangent);

struct ReferenceMotion {
  double thrust_n = 0.0;
  double thrust_rate = 0.0;                                      // N/s
  Eigen::Vector3d body_rates = Eigen::Vector3d::Zero();          // rad/s
  Eigen::Vector3d body_accelerations = Eigen::Vector3d::Zero();  // rad/s^2
};

// Thrust, body rates and body accelerations of a vehicle that is on the reference, its attitude being
// attitude_along() what thrust_attitude() gives for the reference's acceleration, at its yaw; from
// acceleration, jerk, snap and yaw. Where the reference falls so fast that b_z is below kMinimumLift g, b_z
// is taken as that and all derivatives are zero. heading: that of the reference's yaw.
ReferenceMotion reference_motion(double mass_kg, const Reference& reference, const Heading& heading);

}  // namespace swiftlet::control
