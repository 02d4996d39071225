// Rotor observer: the speeds, thrust and moments of the rotors now. It runs the motor model on the sent
// commands and corrects it by measured speeds where they are available. Its moment is the third state of the
// attitude design with motor lag.
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
  // bandwidth: rad/s, > 0, of the correction by measured speeds.
  RotorObserver(const plant::Vehicle& vehicle, double bandwidth);

  // Propagates the speeds by dt_s > 0 under the command in force, at the measured supply voltage. First
  // order with the time constant of Eq. (18), whichever motor model the vehicle file names.
  void step(double dt_s, const plant::ActuatorCommand& command, double supply_voltage_v);

  // The same for a vehicle that chooses the throttles itself: thrust_n is the collective thrust that it is to give,
  // which all rotors share. 0 for rotors that are off.
  void step(double dt_s, double thrust_n);

  // Corrects the speeds by measured ones: a difference decays by exp(-bandwidth dt), dt being the time since
  // the last sample, at any sample rate. The first sample sets the speeds. Ignores samples that are not
  // finite, negative, not newer than the last, or for another number of rotors.
  void correct(const plant::RotorSpeedSample& sample);

  const plant::PerRotor& speeds() const { return speeds_; }         // rad/s
  double thrust_n() const { return wrench_[0]; }                    // along -z of FRD
  Eigen::Vector3d moment_frd() const { return wrench_.tail<3>(); }  // N m, Eq. (28)

 private:
  using Speeds = Eigen::Array<double, plant::kMaxRotors, 1>;
  double kept_over(double dt_s);
  void update_wrench();

  plant::Esc esc_;
  plant::Motor motor_;
  plant::RotorCoefficients rotor_;
  Eigen::Matrix<double, 4, plant::kMaxRotors> wrench_per_square_;  // per speed squared; unused columns: 0
  double bandwidth_;
  int count_ = 0;
  double kept_dt_s_ = 0.0;        // of kept_
  double kept_ = 1.0;             // of a difference in speed, over kept_dt_s_
  std::int64_t measured_ns_ = 0;  // stamp of the last measured speeds; 0: none yet
  plant::PerRotor speeds_{};
  Eigen::Vector4d wrench_ = Eigen::Vector4d::Zero();
};

}  // namespace swiftlet::control
