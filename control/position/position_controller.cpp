#include "swiftlet/control/position/position_controller.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::control {

PositionController::PositionController(const PositionSettings& settings, const Limits& limits,
                                       const ControlDesign& design)
    : k_p_(design.x.gains.k_p, design.y.gains.k_p, design.z.gains.k_p),
      k_v_(design.x.gains.k_v, design.y.gains.k_v, design.z.gains.k_v),
      k_i_(design.x.gains.k_i, design.y.gains.k_i, design.z.gains.k_i),
      integral_limit_(settings.integral_limit),
      max_acceleration_(limits.max_acceleration) {}

PositionCommand PositionController::step(const Eigen::Vector3d& position_ned,
                                         const Eigen::Vector3d& velocity_ned, const Reference& reference,
                                         double dt_s, bool freeze_integral) {
  const Eigen::Vector3d error = reference.position_ned - position_ned;
  const Eigen::Vector3d velocity_error = reference.velocity_ned - velocity_ned;
  const Eigen::Vector3d wanted = reference.acceleration_ned + k_v_.cwiseProduct(velocity_error) +
                                 k_p_.cwiseProduct(error) + integral_;  // Eq. (48)
  PositionCommand command;
  command.acceleration_ned = wanted;
  const double horizontal_squared = wanted.head<2>().squaredNorm();
  const bool cut_horizontal = horizontal_squared > max_acceleration_ * max_acceleration_;
  const bool cut_vertical = std::abs(wanted.z()) > max_acceleration_;
  if (cut_horizontal) command.acceleration_ned.head<2>() *= max_acceleration_ / std::sqrt(horizontal_squared);
  if (cut_vertical) command.acceleration_ned.z() = std::copysign(max_acceleration_, wanted.z());
  command.limited = cut_horizontal || cut_vertical;

  if (freeze_integral) return command;
  for (int i = 0; i < 3; ++i) {
    const double increment = k_i_[i] * error[i] * dt_s;
    const bool winds_up = (i < 2 ? cut_horizontal : cut_vertical) && increment * wanted[i] > 0.0;
    if (winds_up || !std::isfinite(increment)) continue;
    integral_[i] = std::clamp(integral_[i] + increment, -integral_limit_, integral_limit_);
  }
  return command;
}

void PositionController::set_gains(const ControlGains& gains) {
  k_p_ = gains.position_p;
  k_v_ = gains.position_v;
  k_i_ = gains.position_i;
  integral_limit_ = gains.integral_limit;
  integral_ = integral_.cwiseMax(-integral_limit_).cwiseMin(integral_limit_);
}

}  // namespace swiftlet::control
