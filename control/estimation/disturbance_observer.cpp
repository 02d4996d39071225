#include "swiftlet/control/estimation/disturbance_observer.hpp"

#include <cmath>

namespace swiftlet::control {

void DisturbanceObserver::step(double dt_s, const Eigen::Vector3d& specific_force_frd,
                               const Eigen::Quaterniond& q_ned_from_frd, double lift) {
  if (!(settings_.bandwidth > 0.0)) return reset();
  const double bandwidth_dt = settings_.bandwidth * dt_s;
  const Eigen::Vector3d unexplained_frd = specific_force_frd + lift * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d unexplained_ned = q_ned_from_frd * unexplained_frd;
  if (!unexplained_ned.allFinite()) return;
  if (incremental_) {
    filter_.step(dt_s, settings_.bandwidth, unexplained_ned);
    acceleration_ned_ = filter_.value;
  } else {
    acceleration_ned_ += bandwidth_dt / (1.0 + bandwidth_dt) * (unexplained_ned - acceleration_ned_);
  }
  const double squared = acceleration_ned_.squaredNorm();
  if (squared > settings_.limit * settings_.limit) acceleration_ned_ *= settings_.limit / std::sqrt(squared);
  slow_ned_ += bandwidth_dt / (1.0 + bandwidth_dt) * (acceleration_ned_ - slow_ned_);
}

}  // namespace swiftlet::control
