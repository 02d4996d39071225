// Disturbance observer: estimates the acceleration that the modelled thrust does not explain (wind, drag, a
// wrong mass, weak rotors). It is the measured specific force less that of the rotors' thrust (Ohnishi 1987;
// with the accelerometer: Smeur, de Croon, Chu, "Cascaded incremental nonlinear dynamic inversion", 2018).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/estimation/second_order_filter.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

class DisturbanceObserver {
 public:
  // incremental: with a Butterworth filter of second order, as incremental inversion has it, in place of a first-order one.
  explicit DisturbanceObserver(const DisturbanceSettings& settings, bool incremental = false)
      : settings_(settings), incremental_(incremental) {}

  // A step of dt_s > 0 in free flight. specific_force_frd: measured, bias removed, m/s^2. lift: rotor thrust
  // over mass, m/s^2. Low-passes the difference at settings.bandwidth and limits its length to
  // settings.limit. Ignores an input that is not finite. With bandwidth 0 the estimate is zero.
  void step(double dt_s, const Eigen::Vector3d& specific_force_frd, const Eigen::Quaterniond& q_ned_from_frd,
            double lift);

  // Changes the bandwidth and the limit. The estimate goes on from its present value.
  void set(const DisturbanceSettings& settings) { settings_ = settings; }

  // Sets the estimate to zero: for a vehicle on the ground, whose contact force is no disturbance.
  void reset() {
    acceleration_ned_.setZero();
    slow_ned_.setZero();
    filter_ = {};
  }

  const Eigen::Vector3d& acceleration_ned() const { return acceleration_ned_; }  // m/s^2
  // The estimate's rate, m/s^3, behind a second low pass of the same bandwidth.
  Eigen::Vector3d rate_ned() const { return settings_.bandwidth * (acceleration_ned_ - slow_ned_); }

 private:
  DisturbanceSettings settings_;
  bool incremental_;
  SecondOrderFilter filter_;
  Eigen::Vector3d acceleration_ned_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d slow_ned_ = Eigen::Vector3d::Zero();  // m/s^2, the estimate behind a second low pass
};

}  // namespace swiftlet::control
