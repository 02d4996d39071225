#include "swiftlet/control/estimation/takeoff_consistency.hpp"

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

void TakeoffConsistencyMonitor::InertialClimb::step(double dt_s, double acceleration, double memory_s) {
  speed += dt_s * (acceleration - (2.0 * speed + height_m / memory_s) / memory_s);
  height_m += dt_s * speed;
}

void TakeoffConsistencyMonitor::PoseClimb::step(double dt_s, double climb_m, double memory_s) {
  const double part = dt_s / (memory_s + dt_s);
  slow_m += part * (climb_m - slow_m);
  const double once_m = climb_m - slow_m;
  slow_once_m += part * (once_m - slow_once_m);
  height_m = once_m - slow_once_m;
}

void TakeoffConsistencyMonitor::begin(const Eigen::Vector3d& accelerometer_bias_frd, double z_ned) {
  *this = TakeoffConsistencyMonitor(settings_);
  active_ = true;
  start_z_ned_ = z_ned;
  bias_frd_ = accelerometer_bias_frd;
}

void TakeoffConsistencyMonitor::step(double dt_s, const Eigen::Vector3d& specific_force_frd,
                                     const Eigen::Quaterniond& q_ned_from_frd, double z_ned) {
  if (!active_) return;
  elapsed_s_ += dt_s;
  active_ = elapsed_s_ < settings_.longest_s && start_z_ned_ - z_ned < settings_.confirmed_climb_m;
  const double upward = -(q_ned_from_frd * (specific_force_frd - bias_frd_)).z() - plant::kGravity;
  inertial_.step(dt_s, upward, settings_.memory_s);
  by_pose_.step(dt_s, start_z_ned_ - z_ned, settings_.memory_s);
}

}  // namespace swiftlet::control
