// Body-rate control of a flight-control firmware: a PID for each axis, as of Crazyflie and PX4. It knows the vehicle's
// inertia only as a scale of its gains, and does not compensate gyroscopic moments.
#pragma once

#include <Eigen/Core>

#include "swiftlet/plant/simulation/firmware/gains.hpp"

namespace swiftlet::plant {

class RateLoop {
 public:
  RateLoop(const RateGains& gains, const Eigen::Matrix3d& inertia)
      : gains_(gains), inertia_(inertia.diagonal()) {}

  // The moment, N m in FRD. dt_s > 0. The integral stands still unless `integrate`.
  Eigen::Vector3d step(const Eigen::Vector3d& wanted_rates, const Eigen::Vector3d& measured_rates,
                       double dt_s, bool integrate);
  void reset();

  const Eigen::Vector3d& integral() const { return integral_; }  // rad/s^2

 private:
  RateGains gains_;
  Eigen::Vector3d inertia_;
  Eigen::Vector3d integral_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_rates_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d derivative_ = Eigen::Vector3d::Zero();  // of the measured rates, rad/s^2
  bool has_last_ = false;
};

}  // namespace swiftlet::plant
