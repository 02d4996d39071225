// The identified vehicle: plain parameters, as the vehicle file holds them. Equation numbers are those of the
// paper (Phang et al., "Explicit Model Identification and Control of a Micro Aerial Vehicle", ICUAS 2014).
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
  double pulse_range_us = 0.0;  // pulse width at delta = 1, less pulse_min_us
};

// Reduced: first order in speed, tau_m dOmega/dt = Omega_ss(v_a) - Omega.
// Physical: Eq. (10), (15); J_r dOmega/dt = K1 i_a - F Omega - k_Q Omega^2, where i_a is (v_a - K1 Omega) /
// R_a or, with armature_inductance_h > 0, a state of its own. K1, F and J_r follow from the rest:
// motor_dynamics() in motor.hpp.
enum class MotorModel { kReduced, kPhysical };

struct Motor {
  MotorModel model = MotorModel::kReduced;
  double time_constant_s = 0.0;          // tau_m of Eq. (18), the 63.2 % rise of a speed step
  double k2 = 0.0;                       // K2 of Eq. (22), V s/rad
  double k3 = 0.0;                       // K3 of Eq. (22), V s^2/rad^2
  double armature_resistance_ohm = 0.0;  // R_a
  double armature_inductance_h = 0.0;    // L_a; 0: the current follows at once
};

// Eq. (25) and (26).
struct RotorCoefficients {
  double thrust = 0.0;  // k_T, N s^2
  double torque = 0.0;  // k_Q, N m s^2
};

// As seen from above. A rotor that turns counter-clockwise pushes the body clockwise: positive yaw moment.
enum class Spin { kCounterClockwise, kClockwise };

struct RotorMount {
  Eigen::Vector3d position_frd = Eigen::Vector3d::Zero();  // m, hub from the centre of mass
  Spin spin = Spin::kCounterClockwise;
};

// One battery: open-circuit voltage over state of charge, and one lag for the sag under load:
// tau dv_sag/dt = R i - v_sag, v_s = v_oc(soc) - v_sag.
struct BatteryParameters {
  double capacity_ah = 0.0;
  double internal_resistance_ohm = 0.0;
  double sag_time_constant_s = 0.0;
  double electronics_current_a = 0.0;          // drawn besides the motors
  std::vector<double> state_of_charge;         // 0 .. 1, rising, first 0, last 1
  std::vector<double> open_circuit_voltage_v;  // at those, rising
};

struct Vehicle {
  std::string name;
  double mass_kg = 0.0;
  // J in FRD about the centre of mass, kg m^2; symmetric, positive definite.
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  double linear_drag = 0.0;        // N s/m, isotropic, on the velocity through the air
  std::vector<RotorMount> rotors;  // kMinRotors .. kMaxRotors
  RotorCoefficients rotor;
  Motor motor;
  Esc esc;
  BatteryParameters battery;

  int rotor_count() const { return static_cast<int>(rotors.size()); }
};

// Every rule that a vehicle breaks; empty for one that can be simulated and flown. Takes any values, NaN
// included. Besides ranges it checks what the physics demands as a whole: the principal moments of inertia
// obey the triangle inequality, the rotors can produce any roll, pitch and yaw moment, each can hold its
// share of a hover on a full battery between idle and full throttle, and R_a <= K2 K3 / k_Q, since the
// friction F of Eq. (21) is not negative.
std::vector<Violation> validate(const Vehicle& vehicle);

}  // namespace swiftlet::plant
