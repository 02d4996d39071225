// Supply observer: the supply voltage between two battery samples. The voltage sags as the rotors accelerate, by tens of
// millivolts within a sample period; thrust goes with its square.
#pragma once

#include "swiftlet/plant/model/motor.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

class SupplyObserver {
 public:
  // voltage_v: without a sample.
  SupplyObserver(const plant::Vehicle& vehicle, double voltage_v);

  // Propagates the sag by dt_s > 0 under the command in force, at these rotor speeds, rad/s: that of the
  // battery model (plant/model/battery.hpp) at the current of motors and electronics.
  void step(double dt_s, const plant::ActuatorCommand& command, const plant::PerRotor& speeds);
  // A measured voltage, V. What the sag does not explain is the open-circuit voltage, constant until the next.
  void correct(double voltage_v) { unloaded_v_ = voltage_v + sag_v_; }

  double voltage_v() const { return unloaded_v_ - sag_v_; }

 private:
  plant::Esc esc_;
  plant::MotorDynamics motor_;
  double resistance_ohm_;
  double sag_time_constant_s_;
  double electronics_current_a_;
  double unloaded_v_;
  double sag_v_;
};

}  // namespace swiftlet::control
