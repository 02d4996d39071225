#include "swiftlet/plant/model/endurance.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/battery.hpp"
#include "swiftlet/plant/model/motor.hpp"

namespace swiftlet::plant {
namespace {

constexpr int kSteps = 1000;  // from full to empty

// W, without the electronics.
double hover_power(const Vehicle& vehicle) {
  const double speed = hover_speed(vehicle);
  const double voltage_v = voltage_from_steady_speed(vehicle.motor, speed);
  return vehicle.rotor_count() * voltage_v * motor_current(motor_dynamics(vehicle), voltage_v, speed);
}

// v_s of a battery that gives the power and the electronics' current: v_s = v_oc - R (i_e + P / v_s). 0 if it cannot.
double loaded_voltage(const BatteryParameters& battery, double state_of_charge, double power_w) {
  const double resistance = battery.internal_resistance_ohm;
  const double b =
      open_circuit_voltage(battery, state_of_charge) - resistance * battery.electronics_current_a;
  const double square = b * b - 4.0 * resistance * power_w;
  return square >= 0.0 ? 0.5 * (b + std::sqrt(square)) : 0.0;
}

}  // namespace

double hover_voltage(const Vehicle& vehicle, double state_of_charge) {
  return loaded_voltage(vehicle.battery, state_of_charge, hover_power(vehicle));
}

double hover_endurance_s(const Vehicle& vehicle, double state_of_charge, double least_voltage_v) {
  const BatteryParameters& battery = vehicle.battery;
  const double power_w = hover_power(vehicle);
  double endurance_s = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double charge = state_of_charge * (1.0 - static_cast<double>(i) / kSteps);
    const double voltage_v = loaded_voltage(battery, charge, power_w);
    if (voltage_v < std::max(least_voltage_v, 1e-9)) break;
    const double current_a = battery.electronics_current_a + power_w / voltage_v;
    endurance_s += state_of_charge / kSteps * 3600.0 * battery.capacity_ah / current_a;
  }
  return endurance_s;
}

}  // namespace swiftlet::plant
