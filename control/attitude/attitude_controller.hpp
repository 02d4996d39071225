// Attitude control: an LQR with feedback linearisation, Eq. (32)-(40), on the error that the settings
// select: the paper's Euler angles, or the rotation, which has no singularity.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/types/gains.hpp"
#include "swiftlet/math/heading.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

struct AttitudeReference {
  Eigen::Vector3d body_z_ned = Eigen::Vector3d::UnitZ();  // desired direction of body z, unit length
  math::Heading heading;
  // Feed-forward in the reference's own body axes. Leave at zero if not known.
  Eigen::Vector3d body_rates = Eigen::Vector3d::Zero();          // rad/s
  Eigen::Vector3d body_accelerations = Eigen::Vector3d::Zero();  // rad/s^2
};

class AttitudeController {
 public:
  // Throws std::invalid_argument with a sentence if the inertia is not symmetric and positive definite.
  AttitudeController(const plant::Vehicle& vehicle, const AttitudeSettings& settings,
                     const ControlDesign& design);

  // The commanded moments u1 .. u3, N m:
  //   u = J (k (reference - state) + feed forward) + omega x J omega, the last term as in Eq. (35)-(37).
  // The state is (error of attitude.error's kind, body rate), with Eq. (38)-(40) approximating (29)-(31).
  // With kMotorLag it also has the present angular acceleration, from present_moment_frd, the present moment
  // of the rotors (unused otherwise). The feed-forward is omega_r and alpha_r; with kRotation it is rotated from
  // the reference's axes into the body's.
  //
  // Finite at every attitude. Inputs that are not finite give moments that are not finite, which Allocator
  // handles.
  Eigen::Vector3d moments(const Eigen::Quaterniond& q_ned_from_frd, const Eigen::Vector3d& body_rates_frd,
                          const Eigen::Vector3d& present_moment_frd,
                          const AttitudeReference& reference) const;

  // The same for body rates without attitude control: u = J k (desired - rates) + omega x J omega, with the
  // gains of the rates, and with kMotorLag of the present angular acceleration.
  Eigen::Vector3d moments_for_rates(const Eigen::Vector3d& body_rates_frd,
                                    const Eigen::Vector3d& present_moment_frd,
                                    const Eigen::Vector3d& wanted_rates_frd) const;

  // For a vehicle that controls its body rates itself: the rates at which the law of moments() asks for no moment
  // beyond its feed-forward, omega_r + (k_angle / k_rate) e for each axis, with the error e of attitude.error's kind.
  Eigen::Vector3d rates(const Eigen::Quaterniond& q_ned_from_frd, const AttitudeReference& reference) const;

  // Changes the gains, which must be designed on the model of the settings.
  void set_gains(const ControlGains& gains);

 private:
  // Eq. (38)-(40) and (35)-(37). command: the part of moment / inertia that attitude and reference
  // determine.
  Eigen::Vector3d linearised(const Eigen::Vector3d& command, const Eigen::Vector3d& body_rates_frd,
                             const Eigen::Vector3d& present_moment_frd,
                             const Eigen::Vector3d& wanted_acceleration) const;

  AttitudeModel model_;
  AttitudeErrorKind error_;
  bool feed_forward_;
  Eigen::Matrix3d inertia_;
  Eigen::Matrix3d inverse_inertia_;
  Eigen::Vector3d k_angle_, k_rate_, k_acceleration_;  // roll, pitch, yaw
};

}  // namespace swiftlet::control
