#include "swiftlet/control/attitude/attitude_controller.hpp"

#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "swiftlet/control/attitude/attitude_error.hpp"

namespace swiftlet::control {

AttitudeController::AttitudeController(const plant::Vehicle& vehicle, const AttitudeSettings& settings,
                                       const ControlDesign& design)
    : model_(settings.model),
      error_(settings.error),
      feed_forward_(settings.feed_forward),
      inertia_(vehicle.inertia),
      k_angle_(design.roll.k[0], design.pitch.k[0], design.yaw.k[0]),
      k_rate_(design.roll.k[1], design.pitch.k[1], design.yaw.k[1]),
      k_acceleration_(design.roll.k[2], design.pitch.k[2], design.yaw.k[2]) {
  const bool symmetric =
      (inertia_ - inertia_.transpose()).cwiseAbs().maxCoeff() <= 1e-12 * inertia_.cwiseAbs().maxCoeff();
  if (!inertia_.allFinite() || !symmetric || inertia_.llt().info() != Eigen::Success) {
    throw std::invalid_argument("inertia: must be symmetric and positive definite");
  }
  inverse_inertia_ = inertia_.inverse();
}

Eigen::Vector3d AttitudeController::moments(const Eigen::Quaterniond& q_ned_from_frd,
                                            const Eigen::Vector3d& body_rates_frd,
                                            const Eigen::Vector3d& present_moment_frd,
                                            const AttitudeReference& reference) const {
  Eigen::Vector3d angle_error;
  Eigen::Vector3d rates_r = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerations_r = Eigen::Vector3d::Zero();
  if (feed_forward_) {
    rates_r = reference.body_rates;
    accelerations_r = reference.body_accelerations;
  }
  if (error_ == AttitudeErrorKind::kEulerAngles) {
    angle_error = euler_error(q_ned_from_frd, reference.body_z_ned, reference.heading.yaw_rad);
  } else {
    const RotationError error = rotation_error(q_ned_from_frd, reference.body_z_ned, reference.heading);
    angle_error = error.angle;
    rates_r = error.r_frd_from_reference * rates_r;
    accelerations_r = error.r_frd_from_reference * accelerations_r;
  }
  const Eigen::Vector3d command =
      accelerations_r + k_angle_.cwiseProduct(angle_error) + k_rate_.cwiseProduct(rates_r - body_rates_frd);
  return linearised(command, body_rates_frd, present_moment_frd, accelerations_r);
}

Eigen::Vector3d AttitudeController::moments_for_rates(const Eigen::Vector3d& body_rates_frd,
                                                      const Eigen::Vector3d& present_moment_frd,
                                                      const Eigen::Vector3d& wanted_rates_frd) const {
  const Eigen::Vector3d command = k_rate_.cwiseProduct(wanted_rates_frd - body_rates_frd);
  return linearised(command, body_rates_frd, present_moment_frd, Eigen::Vector3d::Zero());
}

Eigen::Vector3d AttitudeController::rates(const Eigen::Quaterniond& q_ned_from_frd,
                                          const AttitudeReference& reference) const {
  Eigen::Vector3d rates_r = feed_forward_ ? reference.body_rates : Eigen::Vector3d(Eigen::Vector3d::Zero());
  Eigen::Vector3d angle_error;
  if (error_ == AttitudeErrorKind::kEulerAngles) {
    angle_error = euler_error(q_ned_from_frd, reference.body_z_ned, reference.heading.yaw_rad);
  } else {
    const RotationError error = rotation_error(q_ned_from_frd, reference.body_z_ned, reference.heading);
    angle_error = error.angle;
    rates_r = error.r_frd_from_reference * rates_r;
  }
  return rates_r + k_angle_.cwiseQuotient(k_rate_).cwiseProduct(angle_error);
}

void AttitudeController::set_gains(const ControlGains& gains) {
  k_angle_ = gains.attitude_angle;
  k_rate_ = gains.attitude_rate;
  k_acceleration_ = gains.attitude_acceleration;
}

Eigen::Vector3d AttitudeController::linearised(const Eigen::Vector3d& from_state,
                                               const Eigen::Vector3d& body_rates_frd,
                                               const Eigen::Vector3d& present_moment_frd,
                                               const Eigen::Vector3d& wanted_acceleration) const {
  const Eigen::Vector3d gyroscopic = body_rates_frd.cross(inertia_ * body_rates_frd);
  Eigen::Vector3d command = from_state;
  if (model_ == AttitudeModel::kMotorLag) {
    const Eigen::Vector3d acceleration = inverse_inertia_ * (present_moment_frd - gyroscopic);  // Eq. (6)
    command += k_acceleration_.cwiseProduct(wanted_acceleration - acceleration);
  }
  return inertia_ * command + gyroscopic;  // Eq. (35)-(37)
}

}  // namespace swiftlet::control
