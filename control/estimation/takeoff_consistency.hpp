// Whether motion capture sees the climb that the accelerometer feels. Poses of another body, or of markers
// that came off, agree with a vehicle that stands; after the lift-off the position loop would push on for
// good, and the estimator take the contradiction for a bias of the accelerometer.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

class TakeoffConsistencyMonitor {
 public:
  explicit TakeoffConsistencyMonitor(const TakeoffConsistencySettings& settings = {}) : settings_(settings) {}

  // On the ground: the watch starts with the next step().
  void begin(const Eigen::Vector3d& accelerometer_bias_frd, double z_ned);

  // A step of dt_s > 0 in flight. specific_force_frd: measured, m/s^2, less the bias that was known on the
  // ground; z_ned: of the estimate, m. Does nothing before begin(), nor once the climb has been seen or
  // settings.longest_s are over.
  void step(double dt_s, const Eigen::Vector3d& specific_force_frd, const Eigen::Quaterniond& q_ned_from_frd,
            double z_ned);

  // The vehicle climbs and its pose does not.
  bool contradicted() const {
    return active_ && inertial_.height_m > settings_.inertial_climb_m &&
           by_pose_.height_m < settings_.min_pose_fraction * inertial_.height_m;
  }

 private:
  // A height behind the high pass s^2 / (s + 1 / memory_s)^2.
  struct Climb {
    double height_m = 0.0;
    double speed = 0.0;  // m/s
    void step(double dt_s, double speed_change, double memory_s);
  };

  TakeoffConsistencySettings settings_;
  bool active_ = false;
  double elapsed_s_ = 0.0;
  double start_z_ned_ = 0.0;
  double z_ned_ = 0.0;
  double speed_ = 0.0;  // m/s, upward, of the estimate's height
  Eigen::Vector3d bias_frd_ = Eigen::Vector3d::Zero();
  Climb inertial_, by_pose_;
};

}  // namespace swiftlet::control
