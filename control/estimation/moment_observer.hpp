// Moment observer: the moment that the modelled rotors do not explain, from the filtered angular acceleration.
// Subtracted from the commanded moment it makes the attitude law incremental: the rotors change by what the measured
// angular acceleration lacks (Smeur, Chu, de Croon, "Adaptive incremental nonlinear dynamic inversion", 2016). The
// rates and the moment of the rotors pass the same filter, so that its lag and that of the rotors are no moment.
#pragma once

#include <Eigen/Core>

#include "swiftlet/control/estimation/second_order_filter.hpp"

namespace swiftlet::control {

class MomentObserver {
 public:
  // limit_frd: N m, each > 0: of the moment's components.
  MomentObserver(const Eigen::Matrix3d& inertia, const Eigen::Vector3d& limit_frd)
      : inertia_(inertia), limit_frd_(limit_frd) {}

  // A step of dt_s > 0 in free flight, with Eq. (6). body_rates_frd: bias removed, rad/s. moment_frd: of the rotors, N m.
  // bandwidth: rad/s; 0: off, as after reset(). Ignores an input that is not finite.
  void step(double dt_s, double bandwidth, const Eigen::Vector3d& body_rates_frd,
            const Eigen::Vector3d& moment_frd);

  // For a vehicle on the ground.
  void reset() { begun_ = false; }

  Eigen::Vector3d moment_frd() const;  // N m, within the limits; 0 before the first step

 private:
  Eigen::Matrix3d inertia_;
  Eigen::Vector3d limit_frd_;
  bool begun_ = false;
  SecondOrderFilter rates_;   // rad/s
  SecondOrderFilter moment_;  // N m, of rotors less gyroscopic moment
};

}  // namespace swiftlet::control
