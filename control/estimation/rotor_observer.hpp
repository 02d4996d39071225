// What the rotors do at this moment: the motor model run on the commands that were sent, corrected by
// measured speeds where they come. Its moment is the third state of the attitude design with motor lag.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/motor.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

class RotorObserver {
 public:
  // bandwidth: rad/s, > 0, at which measured speeds draw the model's.
  RotorObserver(const plant::Vehicle& vehicle, double bandwidth);

  // Runs the speeds on by dt_s > 0 under the command that has been in force, at the measured supply voltage.
  // First order with Eq. (18)'s time constant, whichever motor model the vehicle file names.
  void step(double dt_s, const plant::ActuatorCommand& command, double supply_voltage_v);

  // Draws the speeds towards measured ones: a difference falls by exp(-bandwidth dt), dt being the time since
  // the last sample, at whichever rate they come; the first is taken as it is. Ignored unless finite, not
  // negative, newer than the last and for the vehicle's number of rotors.
  void correct(const plant::RotorSpeedSample& sample);

  const plant::PerRotor& speeds() const { return speeds_; }         // rad/s
  double thrust_n() const { return wrench_[0]; }                    // along -z of FRD
  Eigen::Vector3d moment_frd() const { return wrench_.tail<3>(); }  // N m, Eq. (28)

 private:
  using Speeds = Eigen::Array<double, plant::kMaxRotors, 1>;
  void update_wrench();

  plant::Esc esc_;
  plant::Motor motor_;
  Eigen::Matrix<double, 4, plant::kMaxRotors> wrench_per_square_;  // of each speed; columns of no rotor: 0
  double bandwidth_;
  int count_ = 0;
  std::int64_t measured_ns_ = 0;  // stamp of the last measured speeds; 0: none yet
  plant::PerRotor speeds_{};
  Eigen::Vector4d wrench_ = Eigen::Vector4d::Zero();
};

}  // namespace swiftlet::control
