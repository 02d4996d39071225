// Monitors whether the poses show the climb that the accelerometer measures after lift-off. Poses of another
// body, or of markers that came off, agree with a vehicle on the ground. In flight the position loop would
// climb without end, and the estimator would take the contradiction for an accelerometer bias.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

class TakeoffConsistencyMonitor {
 public:
  explicit TakeoffConsistencyMonitor(const TakeoffConsistencySettings& settings = {}) : settings_(settings) {}

  // Called on the ground: monitoring starts with the next step().
  void begin(const Eigen::Vector3d& accelerometer_bias_frd, double z_ned);

  // A step of dt_s > 0 in flight. specific_force_frd: measured, m/s^2; the bias given to begin() is
  // subtracted. z_ned: of the estimate, m. Does nothing before begin(), and after the climb is confirmed or
  // settings.longest_s has passed.
  void step(double dt_s, const Eigen::Vector3d& specific_force_frd, const Eigen::Quaterniond& q_ned_from_frd,
            double z_ned);

  // The accelerometer shows a climb and the poses do not.
  bool contradicted() const {
    return active_ && inertial_.height_m > settings_.inertial_climb_m &&
           by_pose_.height_m < settings_.min_pose_fraction * inertial_.height_m;
  }

 private:
  // A height after the high pass s^2 / (s + 1 / memory_s)^2, of an acceleration and of a height. Samples may follow each other at
  // any interval.
  struct InertialClimb {
    double height_m = 0.0;
    double speed = 0.0;  // m/s
    void step(double dt_s, double acceleration, double memory_s);
  };
  struct PoseClimb {
    double height_m = 0.0;
    double slow_m = 0.0;       // of the climb: what the first pass takes away
    double slow_once_m = 0.0;  // and the second
    void step(double dt_s, double climb_m, double memory_s);
  };

  TakeoffConsistencySettings settings_;
  bool active_ = false;
  double elapsed_s_ = 0.0;
  double start_z_ned_ = 0.0;
  Eigen::Vector3d bias_frd_ = Eigen::Vector3d::Zero();
  InertialClimb inertial_;
  PoseClimb by_pose_;
};

}  // namespace swiftlet::control
