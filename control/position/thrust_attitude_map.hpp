// The map between the loops: the acceleration from the outer loop to thrust and its direction, and the
// derivatives of a smooth reference to body rates and accelerations (differential flatness).
#pragma once

#include <Eigen/Core>

#include "swiftlet/control/types/reference.hpp"
#include "swiftlet/math/heading.hpp"

namespace swiftlet::control {

struct ThrustAttitude {
  double thrust_n = 0.0;                                  // > 0
  Eigen::Vector3d body_z_ned = Eigen::Vector3d::UnitZ();  // unit length; the thrust acts against it
  bool limited = false;                                   // the acceleration was clipped
};

// The least upward specific force commanded, as a fraction of g: no acceleration command makes the vehicle
// fall faster than 0.9 g or turn over.
constexpr double kMinimumLift = 0.1;

// b = g e3 - a, thrust = m |b|, body z along b. The vertical part has priority: b_z is kept (at least
// kMinimumLift g), and b_x and b_y are scaled down until the tilt is within max_tilt_tangent. An
// acceleration that is not finite counts as 0 and sets limited.
ThrustAttitude thrust_attitude(double mass_kg, const Eigen::Vector3d& acceleration_ned,
                               double max_tilt_tangent);

struct ReferenceMotion {
  double thrust_n = 0.0;
  double thrust_rate = 0.0;                                      // N/s
  Eigen::Vector3d body_rates = Eigen::Vector3d::Zero();          // rad/s
  Eigen::Vector3d body_accelerations = Eigen::Vector3d::Zero();  // rad/s^2
};

// Thrust, body rates and body accelerations of a vehicle on the reference, from acceleration, jerk, snap and
// yaw. Its attitude is attitude_along() the body z axis of thrust_attitude() for the reference's
// acceleration, at the reference's yaw. If the reference falls so fast that b_z < kMinimumLift g, b_z is set
// to that and all derivatives are zero. heading: of the reference's yaw.
ReferenceMotion reference_motion(double mass_kg, const Reference& reference, const math::Heading& heading);

}  // namespace swiftlet::control
