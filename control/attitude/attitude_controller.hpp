// Attitude: the paper's inner loop, an LQR on Euler angles behind feedback linearisation, Eq. (29)-(40).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "control/design/control_design.hpp"
#include "plant/model/vehicle.hpp"

namespace swiftlet::control {

// (phi, theta, psi) of Eq. (3): phi and psi in -pi .. pi, theta in -pi/2 .. pi/2. At theta = +-pi/2, where
// phi and psi are one angle, psi is 0.
Eigen::Vector3d euler_from_quaternion(const Eigen::Quaterniond& q_ned_from_frd);
Eigen::Quaterniond quaternion_from_euler(const Eigen::Vector3d& euler_rad);

// The same angle in -pi .. pi.
double wrap_angle(double angle_rad);

struct AttitudeReference {
  Eigen::Vector3d euler_rad = Eigen::Vector3d::Zero();  // phi, theta, psi
  // Fed forward; leave zero where they are not known.
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();          // rad/s
  Eigen::Vector3d body_accelerations_frd = Eigen::Vector3d::Zero();  // rad/s^2
  Eigen::Vector3d body_jerks_frd = Eigen::Vector3d::Zero();  // rad/s^3, leads the rotor lag (kMotorLag)
};

class AttitudeController {
 public:
  // Throws std::invalid_argument with a sentence if the inertia is not symmetric and positive definite.
  AttitudeController(const plant::Vehicle& vehicle, const AttitudeSettings& settings,
                     const ControlDesign& design);

  // The moments u1 .. u3 to be commanded, N m:
  //   u = J (k (reference - state) + feed forward) + omega x J omega, the last as in Eq. (35)-(37).
  // The state is (angle, body rate), as Eq. (38)-(40) approximate (29)-(31), and with kMotorLag the present
  // angular acceleration, from present_moment_frd, the moment that the rotors give now (unused otherwise).
  // Fed forward is alpha_r, with kMotorLag alpha_r + tau d(alpha_r)/dt, so that it arrives in time behind the
  // lag.
  //
  // Nothing in the law divides by cos(theta): at theta = +-90 degrees it stays finite, but phi and psi jump
  // there, so it does not hold an attitude beyond about +-80 degrees of pitch. An input that is not finite
  // gives moments that are not finite, which Allocator takes.
  Eigen::Vector3d moments(const Eigen::Vector3d& euler_rad, const Eigen::Vector3d& body_rates_frd,
                          const Eigen::Vector3d& present_moment_frd,
                          const AttitudeReference& reference) const;

 private:
  AttitudeModel model_;
  bool feed_forward_;
  double rotor_lag_s_;
  Eigen::Matrix3d inertia_;
  Eigen::Matrix3d inverse_inertia_;
  Eigen::Vector3d k_angle_, k_rate_, k_acceleration_;  // roll, pitch, yaw
};

}  // namespace swiftlet::control
