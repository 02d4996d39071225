// Motor with its rotor, Eq. (10)-(22): voltage v_a in V <-> speed Omega in rad/s, in the steady state and in
// transients. A motor turns in one direction only: the steady-state functions take voltages and speeds below
// 0 as 0.
#pragma once

#include <algorithm>
#include <cmath>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant {

// Eq. (22): the voltage v_a, V, of a steady speed.
inline double voltage_from_steady_speed(const Motor& motor, double speed) {
  const double omega = std::max(speed, 0.0);
  return motor.k2 * omega + motor.k3 * omega * omega;
}

// Inverse of Eq. (22), Omega_ss(v_a). The positive root in a form without cancellation:
// (-K2 + sqrt(K2^2 + 4 K3 v_a)) / (2 K3) = 2 v_a / (K2 + sqrt(K2^2 + 4 K3 v_a)).
inline double steady_speed_from_voltage(const Motor& motor, double voltage_v) {
  const double v_a = std::max(voltage_v, 0.0);
  return 2.0 * v_a / (motor.k2 + std::sqrt(motor.k2 * motor.k2 + 4.0 * motor.k3 * v_a));
}

// Constants in the equations of motion of one motor with its rotor, computed from the identified values. K1
// and F are not free parameters: Eq. (21) gives K1 = R_a k_Q / K3 and F = (K2 - K1) K1 / R_a.
struct MotorDynamics {
  Motor motor;
  double torque_constant = 0.0;        // K1 of Eq. (13) and (14), N m/A = V s/rad
  double friction = 0.0;               // F of Eq. (15), N m s/rad
  double rotor_torque = 0.0;           // k_Q of Eq. (16), N m s^2
  double rotor_inertia = 0.0;          // J_r of Eq. (15), kg m^2
  double inverse_inertia = 0.0;        // 1 / J_r
  double inverse_time_constant = 0.0;  // 1 / tau_m
  double inverse_resistance = 0.0;     // 1 / R_a

  // True if the armature current is integrated as a state.
  bool has_current_state() const {
    return motor.model == MotorModel::kPhysical && motor.armature_inductance_h > 0.0;
  }
};

// Derives the constants for a vehicle that validate() accepts. J_r is chosen to match the way in which tau_m
// of Eq. (18) was measured: with L_a = 0, after a step of v_a from rest to the voltage of the hover speed,
// the rotor reaches 63.2 % (1 - 1/e) of that speed after time_constant_s.
MotorDynamics motor_dynamics(const Vehicle& vehicle);

// Eq. (10) and (17) with L_a = 0: i_a = (v_a - K1 Omega) / R_a. Negative when the motor brakes.
inline double motor_current(const MotorDynamics& dynamics, double voltage_v, double speed) {
  return (voltage_v - dynamics.torque_constant * speed) * dynamics.inverse_resistance;
}

// Eq. (10): di_a/dt, A/s, for models with a current state. Integrate with steps well below the time constant
// L_a / R_a.
inline double motor_current_rate(const MotorDynamics& dynamics, double voltage_v, double current_a,
                                 double speed) {
  return (voltage_v - dynamics.motor.armature_resistance_ohm * current_a - dynamics.torque_constant * speed) /
         dynamics.motor.armature_inductance_h;
}

// Eq. (15) and (16): dOmega/dt, rad/s^2, from the current. The rotor's torque always opposes its rotation.
inline double speed_rate_from_current(const MotorDynamics& dynamics, double current_a, double speed) {
  const double rotor_torque = dynamics.rotor_torque * speed * std::abs(speed);  // Q
  return (dynamics.torque_constant * current_a - rotor_torque - dynamics.friction * speed) *
         dynamics.inverse_inertia;
}

// dOmega/dt, rad/s^2, from the voltage, for models without a current state.
// Reduced: tau_m dOmega/dt = Omega_ss(v_a) - Omega.
// Physical, Eq. (10) and (15) with L_a = 0: J_r dOmega/dt = (K1 / R_a) (v_a - K2 Omega - K3 Omega^2).
inline double speed_rate_from_voltage(const MotorDynamics& dynamics, double voltage_v, double speed) {
  if (dynamics.motor.model == MotorModel::kReduced) {
    return (steady_speed_from_voltage(dynamics.motor, voltage_v) - speed) * dynamics.inverse_time_constant;
  }
  return speed_rate_from_current(dynamics, motor_current(dynamics, voltage_v, speed), speed);
}

}  // namespace swiftlet::plant
