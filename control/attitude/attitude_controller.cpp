#include "control/attitude/attitude_controller.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace swiftlet::control {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kGimbalCosine = 1e-6;  // of theta; closer to +-90 degrees psi is taken as 0

}  // namespace

double wrap_angle(double angle_rad) {
  return std::abs(angle_rad) <= kPi ? angle_rad : std::remainder(angle_rad, 2.0 * kPi);
}

Eigen::Vector3d euler_from_quaternion(const Eigen::Quaterniond& q_ned_from_frd) {
  const Eigen::Matrix3d r = q_ned_from_frd.toRotationMatrix();
  const double cosine = std::sqrt(r(2, 1) * r(2, 1) + r(2, 2) * r(2, 2));
  const double theta = std::atan2(-r(2, 0), cosine);
  if (cosine < kGimbalCosine) {
    return {theta > 0.0 ? std::atan2(r(0, 1), r(1, 1)) : std::atan2(-r(0, 1), r(1, 1)), theta, 0.0};
  }
  return {std::atan2(r(2, 1), r(2, 2)), theta, std::atan2(r(1, 0), r(0, 0))};
}

Eigen::Quaterniond quaternion_from_euler(const Eigen::Vector3d& euler_rad) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return AngleAxisd(euler_rad[2], Vector3d::UnitZ()) * AngleAxisd(euler_rad[1], Vector3d::UnitY()) *
         AngleAxisd(euler_rad[0], Vector3d::UnitX());
}

AttitudeController::AttitudeController(const plant::Vehicle& vehicle, const AttitudeSettings& settings,
                                       const ControlDesign& design)
    : model_(settings.model),
      feed_forward_(settings.feed_forward),
      rotor_lag_s_(design.rotor_lag_s),
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

Eigen::Vector3d AttitudeController::moments(const Eigen::Vector3d& euler_rad,
                                            const Eigen::Vector3d& body_rates_frd,
                                            const Eigen::Vector3d& present_moment_frd,
                                            const AttitudeReference& reference) const {
  Eigen::Vector3d angle_error = reference.euler_rad - euler_rad;
  for (double& angle : angle_error) angle = wrap_angle(angle);

  Eigen::Vector3d rates_r = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerations_r = Eigen::Vector3d::Zero();
  if (feed_forward_) {
    rates_r = reference.body_rates_frd;
    accelerations_r = reference.body_accelerations_frd;
  }
  const Eigen::Vector3d gyroscopic = body_rates_frd.cross(inertia_ * body_rates_frd);

  // Eq. (38)-(40): commanded moment / inertia.
  Eigen::Vector3d command =
      accelerations_r + k_angle_.cwiseProduct(angle_error) + k_rate_.cwiseProduct(rates_r - body_rates_frd);
  if (model_ == AttitudeModel::kMotorLag) {
    const Eigen::Vector3d acceleration = inverse_inertia_ * (present_moment_frd - gyroscopic);  // Eq. (6)
    command += k_acceleration_.cwiseProduct(accelerations_r - acceleration);
    if (feed_forward_) command += rotor_lag_s_ * reference.body_jerks_frd;
  }
  return inertia_ * command + gyroscopic;  // Eq. (35)-(37)
}

}  // namespace swiftlet::control
