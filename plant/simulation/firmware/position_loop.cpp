#include "swiftlet/plant/simulation/firmware/position_loop.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::plant {
namespace {

// Least upward specific force that the direction of thrust assumes, as a fraction of g.
constexpr double kLeastLift = 0.2;

// The attitude with this body z axis whose body x axis points to yaw_rad, seen from above.
Eigen::Quaterniond attitude_of(const Eigen::Vector3d& body_z_ned, double yaw_rad) {
  const Eigen::Vector3d right_of_yaw(-std::sin(yaw_rad), std::cos(yaw_rad), 0.0);
  const Eigen::Vector3d body_x = right_of_yaw.cross(body_z_ned).normalized();
  Eigen::Matrix3d axes;
  axes << body_x, body_z_ned.cross(body_x), body_z_ned;
  return Eigen::Quaterniond(axes);
}

}  // namespace

Eigen::Vector3d PositionLoop::acceleration(const TrajectorySetpoint& wanted,
                                           const Eigen::Vector3d& position_ned,
                                           const Eigen::Vector3d& velocity_ned, double dt_s, bool integrate) {
  Eigen::Vector3d correction = Eigen::Vector3d::Zero();
  if (wanted.position_used) correction = gains_.position_p * (wanted.position_ned - position_ned);
  const double speed = correction.norm();
  if (speed > gains_.max_correction_m_s) correction *= gains_.max_correction_m_s / speed;
  const Eigen::Vector3d error = wanted.velocity_ned + correction - velocity_ned;
  if (integrate) {
    integral_ += dt_s * gains_.velocity_i * error;
    integral_ = integral_.cwiseMax(-gains_.integral_limit).cwiseMin(gains_.integral_limit);
  }
  const Eigen::Vector3d feedback = gains_.velocity_p * error + integral_;
  return wanted.acceleration_ned +
         feedback.cwiseMax(-gains_.max_acceleration).cwiseMin(gains_.max_acceleration);
}

AttitudeAndThrust PositionLoop::step(const TrajectorySetpoint& wanted, const Eigen::Vector3d& position_ned,
                                     const Eigen::Vector3d& velocity_ned,
                                     const Eigen::Quaterniond& q_ned_from_frd, double dt_s, bool integrate) {
  const Eigen::Vector3d a = acceleration(wanted, position_ned, velocity_ned, dt_s, integrate);
  const double lift = std::max(kGravity - a.z(), 0.0);
  Eigen::Vector3d along(-a.x(), -a.y(), std::max(lift, kLeastLift * kGravity));
  const double most = along.z() * std::tan(gains_.max_tilt_rad);
  const double sideways = along.head<2>().norm();
  if (sideways > most) along.head<2>() *= most / sideways;
  const Eigen::Vector3d body_z_ned = along.normalized();
  const Eigen::Vector3d present_z_ned = q_ned_from_frd * Eigen::Vector3d::UnitZ();
  AttitudeAndThrust out;
  out.q_ned_from_frd = attitude_of(body_z_ned, wanted.yaw_rad);
  out.thrust_n = mass_kg_ * lift / body_z_ned.z() * std::max(body_z_ned.dot(present_z_ned), 0.0);
  return out;
}

}  // namespace swiftlet::plant
