#include "swiftlet/control/estimation/supply_observer.hpp"

#include <algorithm>

#include "swiftlet/plant/model/esc.hpp"

namespace swiftlet::control {

SupplyObserver::SupplyObserver(const plant::Vehicle& vehicle, double voltage_v)
    : esc_(vehicle.esc),
      motor_(plant::motor_dynamics(vehicle)),
      resistance_ohm_(vehicle.battery.internal_resistance_ohm),
      sag_time_constant_s_(vehicle.battery.sag_time_constant_s),
      electronics_current_a_(vehicle.battery.electronics_current_a),
      unloaded_v_(voltage_v),
      sag_v_(0.0) {}

void SupplyObserver::step(double dt_s, const plant::ActuatorCommand& command, const plant::PerRotor& speeds) {
  double power_w = 0.0;
  if (command.rotor_state == plant::RotorState::kRunning) {
    for (int i = 0; i < command.rotor_count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      const double v_a = plant::motor_voltage(esc_, voltage_v(), command.throttle[n]);
      power_w += std::max(v_a * plant::motor_current(motor_, v_a, speeds[n]), 0.0);
    }
  }
  const double current_a = electronics_current_a_ + (voltage_v() > 0.0 ? power_w / voltage_v() : 0.0);
  sag_v_ += dt_s / (sag_time_constant_s_ + dt_s) * (resistance_ohm_ * current_a - sag_v_);
}

}  // namespace swiftlet::control
