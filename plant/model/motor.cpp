#include "swiftlet/plant/model/motor.hpp"

#include "swiftlet/plant/model/airframe.hpp"

namespace swiftlet::plant {

namespace {

// J_r from the rise time of a step from rest. With c = K1 / R_a = k_Q / K3 and the final speed s, the
// physical model is the Riccati equation
//   J_r dOmega/dt = c (v_a - K2 Omega - K3 Omega^2) = k_Q (s - Omega) (Omega + s'),  s' = s + K2 / K3.
// Separation of variables and integration from 0 to (1 - 1/e) s give
//   t = J_r / (k_Q (s + s')) (1 + ln(1 + (1 - 1/e) s / s')).
double rotor_inertia_from_rise_time(const Motor& motor, double rotor_torque, double final_speed) {
  const double other_root = final_speed + motor.k2 / motor.k3;
  const double rise = 1.0 - std::exp(-1.0);
  return motor.time_constant_s * rotor_torque * (final_speed + other_root) /
         (1.0 + std::log1p(rise * final_speed / other_root));
}

}  // namespace

MotorDynamics motor_dynamics(const Vehicle& vehicle) {
  const Motor& motor = vehicle.motor;
  MotorDynamics out;
  out.motor = motor;
  out.rotor_torque = vehicle.rotor.torque;
  out.torque_constant = motor.armature_resistance_ohm * vehicle.rotor.torque / motor.k3;
  out.friction = (motor.k2 - out.torque_constant) * out.torque_constant / motor.armature_resistance_ohm;
  out.rotor_inertia = rotor_inertia_from_rise_time(motor, vehicle.rotor.torque, hover_speed(vehicle));
  out.inverse_inertia = 1.0 / out.rotor_inertia;
  out.inverse_time_constant = 1.0 / motor.time_constant_s;
  out.inverse_resistance = 1.0 / motor.armature_resistance_ohm;
  return out;
}

}  // namespace swiftlet::plant
