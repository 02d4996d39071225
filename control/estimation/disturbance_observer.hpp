// What pushes the vehicle besides the thrust that is known: wind, drag, a wrong mass, weak rotors. The
// accelerometer feels all of it at once; what the rotors' thrust explains is taken away (a disturbance
// observer: Ohnishi 1987; with the accelerometer as here: Smeur, de Croon, Chu, "Cascaded incremental
// nonlinear dynamic inversion", 2018).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

class DisturbanceObserver {
 public:
  explicit DisturbanceObserver(const DisturbanceSettings& settings) : settings_(settings) {}

  // A step of dt_s > 0 in free flight. specific_force_frd: measured, bias removed, m/s^2; lift: what the
  // rotors' thrust gives, thrust over mass, m/s^2. Low-passed at settings.bandwidth, its length kept within
  // settings.limit; an input that is not finite changes nothing. Bandwidth 0: it stays zero.
  void step(double dt_s, const Eigen::Vector3d& specific_force_frd, const Eigen::Quaterniond& q_ned_from_frd,
            double lift);

  // Forgets: the vehicle stands on something that carries it.
  void reset() { acceleration_ned_.setZero(); }

  const Eigen::Vector3d& acceleration_ned() const { return acceleration_ned_; }  // m/s^2

 private:
  DisturbanceSettings settings_;
  Eigen::Vector3d acceleration_ned_ = Eigen::Vector3d::Zero();
};

}  // namespace swiftlet::control
