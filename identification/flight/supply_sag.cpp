#include "swiftlet/identification/flight/supply_sag.hpp"

#include <algorithm>

#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/battery.hpp"
#include "swiftlet/plant/model/propulsion.hpp"

namespace swiftlet::identification {
namespace {

constexpr double kCharge = 0.5;
constexpr double kCommandStep = 1e-3;  // of the command
constexpr int kIterations = 60;        // each reduces the error to the fraction of the voltage that sags

// Steady supply voltage, V, with all rotors at this command.
double settled_voltage(const plant::Vehicle& vehicle, const plant::MotorDynamics& motor, double command) {
  const plant::BatteryParameters& battery = vehicle.battery;
  const double open_circuit = plant::open_circuit_voltage(battery, kCharge);
  double voltage = open_circuit;
  for (int i = 0; i < kIterations; ++i) {
    const double v_a = plant::motor_voltage(vehicle.esc, voltage, command);
    const double current =
        plant::motor_current(motor, v_a, plant::steady_speed_from_voltage(vehicle.motor, v_a));
    const double drawn = battery.electronics_current_a +
                         vehicle.rotor_count() * plant::esc_supply_current(voltage, v_a, current);
    voltage = std::max(open_circuit - battery.internal_resistance_ohm * drawn, 0.0);
  }
  return voltage;
}

double hover_command(const plant::Vehicle& vehicle, const plant::MotorDynamics& motor) {
  double command = 0.5;
  for (int i = 0; i < kIterations; ++i) {
    command = plant::throttle_from_steady_thrust(vehicle, settled_voltage(vehicle, motor, command),
                                                 plant::hover_thrust(vehicle));
  }
  return std::clamp(command, 2.0 * kCommandStep, 1.0 - 2.0 * kCommandStep);
}

}  // namespace

double shared_over_single(const plant::Vehicle& vehicle) {
  const plant::MotorDynamics motor = plant::motor_dynamics(vehicle);
  const double hover = hover_command(vehicle, motor);
  const double at_hover = settled_voltage(vehicle, motor, hover);
  const auto thrust = [&](double voltage, double command) {
    return plant::steady_thrust_from_throttle(vehicle, voltage, command);
  };
  const double single = thrust(at_hover, hover + kCommandStep) - thrust(at_hover, hover - kCommandStep);
  const double shared = thrust(settled_voltage(vehicle, motor, hover + kCommandStep), hover + kCommandStep) -
                        thrust(settled_voltage(vehicle, motor, hover - kCommandStep), hover - kCommandStep);
  return std::clamp(shared / single, 0.1, 1.0);
}

}  // namespace swiftlet::identification
