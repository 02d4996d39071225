// Parameters of an identified vehicle. vehicle_visit.hpp has their keys in the vehicle file and their limits. Equation
// numbers are those of the paper (Phang et al., "Explicit Model Identification and Control of a Micro Aerial Vehicle", ICUAS
// 2014).
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/violation.hpp"

namespace swiftlet::plant {

constexpr double kGravity = 9.80665;  // m/s^2, standard gravity

// ESC, Eq. (8) and (9): v_a^2 = gain * v_s^2 * delta + offset,
// delta = (pulse width - pulse_min) / pulse_range.
struct Esc {
  double gain = 0.0;            // 1
  double offset_v2 = 0.0;       // V^2
  double pulse_min_us = 0.0;    // pulse width at delta = 0
  double pulse_range_us = 0.0;  // pulse width at delta = 1 minus pulse_min_us
};

// Reduced: first order in speed, tau_m dOmega/dt = Omega_ss(v_a) - Omega.
// Physical: Eq. (10) and (15), J_r dOmega/dt = K1 i_a - F Omega - k_Q Omega^2. The current i_a is (v_a - K1
// Omega) / R_a or, with armature_inductance_h > 0, an additional state. motor_dynamics() in motor.hpp
// computes K1, F and J_r from the parameters below.
enum class MotorModel { kReduced, kPhysical };

struct Motor {
  MotorModel model = MotorModel::kReduced;
  double time_constant_s = 0.0;          // tau_m of Eq. (18), the 63.2 % rise of a speed step
  double k2 = 0.0;                       // K2 of Eq. (22), V s/rad
  double k3 = 0.0;                       // K3 of Eq. (22), V s^2/rad^2
  double armature_resistance_ohm = 0.0;  // R_a
  double armature_inductance_h = 0.0;    // L_a; 0: no electrical lag
};

// Eq. (25) and (26).
struct RotorCoefficients {
  double thrust = 0.0;  // k_T, N s^2
  double torque = 0.0;  // k_Q, N m s^2
};

// Sense of rotation seen from above. A counter-clockwise rotor turns the body clockwise: positive yaw moment.
enum class Spin { kCounterClockwise, kClockwise };

struct RotorMount {
  Eigen::Vector3d position_frd = Eigen::Vector3d::Zero();  // m, hub relative to the centre of mass
  Spin spin = Spin::kCounterClockwise;
};

// Battery: open-circuit voltage over state of charge, and a first-order lag for the sag under load:
// tau dv_sag/dt = R i - v_sag, v_s = v_oc(soc) - v_sag.
struct BatteryParameters {
  double capacity_ah = 0.0;
  double internal_resistance_ohm = 0.0;
  double sag_time_constant_s = 0.0;
  double electronics_current_a = 0.0;          // drawn by everything except the motors
  std::vector<double> state_of_charge;         // 0 .. 1, ascending, first 0, last 1
  std::vector<double> open_circuit_voltage_v;  // at these states of charge, ascending
};

struct Vehicle {
  std::string name;
  double mass_kg = 0.0;
  // Inertia J in FRD about the centre of mass, kg m^2; symmetric, positive definite.
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  double linear_drag = 0.0;        // N s/m, isotropic, times the velocity relative to the air
  std::vector<RotorMount> rotors;  // kMinRotors .. kMaxRotors entries
  RotorCoefficients rotor;
  Motor motor;
  Esc esc;
  BatteryParameters battery;

  int rotor_count() const { return static_cast<int>(rotors.size()); }
};

// Returns every rule that the vehicle violates; empty for a vehicle that can be simulated and flown. Accepts
// any values, NaN included. Besides the ranges it checks that
// - the principal moments of inertia satisfy the triangle inequality,
// - the rotors can produce thrust, roll, pitch and yaw moment independently,
// - each rotor's thrust in hover lies between those of throttle 0 and 1 on a full battery,
// - R_a <= K2 K3 / k_Q, since the friction F of Eq. (21) cannot be negative.
std::vector<Violation> validate(const Vehicle& vehicle);

}  // namespace swiftlet::plant
