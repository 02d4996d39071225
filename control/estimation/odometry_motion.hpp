// The motion between successive samples of a vehicle's own estimate, as an IMU on the vehicle would have measured it: for the
// estimator, and for all that uses the specific force.
#pragma once

#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::control {

class OdometryMotion {
 public:
  // The mean motion since the last sample. The mean specific force is that of the change of velocity, the mean rates are
  // those of the change of attitude: propagated with them, an estimate changes as the vehicle's own.
  //
  // Of a sample whose stamp is closer to the last than a third of the usual interval, as of a clock that is
  // set, the force is that of before; the next sample tells the motion since the one before it.
  //
  // A jump, at which `resets` has counted up, is no motion: the force of before goes on, with the rates of both samples.
  // Without velocity, the force is that of the rotors, specific_thrust (m/s^2, thrust over mass), or that at rest while they
  // give less than half of the weight.
  MeanMotion step(const plant::OdometrySample& sample, double specific_thrust);

 private:
  Eigen::Vector3d specific_force(const plant::OdometrySample& sample, double specific_thrust) const;

  plant::OdometrySample last_;
  double interval_s_ = 0.0;  // usual, between two samples
  bool has_last_ = false;
  Eigen::Vector3d last_force_frd_ = Eigen::Vector3d::Zero();
};

}  // namespace swiftlet::control
