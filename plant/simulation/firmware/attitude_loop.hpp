// Attitude control of a flight-control firmware: body rates proportional to the rotation error, as of PX4 (Brescianini,
// Hehn, D'Andrea, "Nonlinear quadrocopter attitude control", ETH 2013, without its part for yaw).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/plant/simulation/firmware/gains.hpp"

namespace swiftlet::plant {

class AttitudeLoop {
 public:
  explicit AttitudeLoop(const AttitudeGains& gains) : gains_(gains) {}

  // The body rates to the wanted attitude, rad/s. rates_ahead: those of the wanted attitude in its own axes, fed
  // forward.
  Eigen::Vector3d step(const Eigen::Quaterniond& wanted, const Eigen::Vector3d& rates_ahead,
                       const Eigen::Quaterniond& q_ned_from_frd) const {
    const Eigen::Quaterniond error = q_ned_from_frd.conjugate() * wanted;
    const Eigen::Vector3d angle = (error.w() < 0.0 ? -2.0 : 2.0) * error.vec();
    const Eigen::Vector3d rates = gains_.p.cwiseProduct(angle) + error * rates_ahead;
    return rates.cwiseMax(-gains_.max_rate).cwiseMin(gains_.max_rate);
  }

 private:
  AttitudeGains gains_;
};

}  // namespace swiftlet::plant
