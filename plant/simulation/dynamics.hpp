// Eq. (1)-(28) as one system of ordinary differential equations, integrated by the classical Runge-Kutta
// method of order 4: rigid body in NED velocities with quaternion attitude, ESC, motors, rotors and battery
// in one state.
//
//   dp/dt = v                                        Eq. (1)
//   m dv/dt = R F + m g z - c (v - wind)             Eq. (5), written in NED; c is the vehicle's linear drag
//   dq/dt = q (0, w) / 2                             Eq. (2)-(4) without their singularity
//   J dw/dt = M - w x J w                            Eq. (6)
//   rotors: Eq. (9), (18) or (10)-(16), (25)-(28); battery: vehicle.hpp, drawn from by the power that the
//   motors take.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/plant/model/motor.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/pairs.hpp"
#include "swiftlet/plant/simulation/vehicle_state.hpp"

namespace swiftlet::plant {

// Where v_s of Eq. (9) comes from: the vehicle's battery, or a source of constant voltage.
struct Supply {
  bool ideal = false;
  double voltage_v = 0.0;  // of the ideal source

  static Supply battery() { return {}; }
  static Supply constant(double voltage_v) { return {true, voltage_v}; }
};

// What acts on a vehicle besides its own equations.
struct Disturbance {
  Eigen::Vector3d force_ned = Eigen::Vector3d::Zero();                // N, at the centre of mass
  Eigen::Vector3d moment_frd = Eigen::Vector3d::Zero();               // N m
  double supply_drop_v = 0.0;                                         // of the open-circuit voltage
  PerRotor rotor_factors = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};  // of thrust and torque
};

// The forms that the motor's equations take: Eq. (18); Eq. (15) with the current at once; Eq. (10) and (15).
enum class MotorForm { kReduced, kPhysical, kInductive };

// The instructions that steps are made of: the best that the processor has, or those that all processors
// have. Results are the same to the last bit.
enum class Instructions { kBest, kBaseline };

class Dynamics {
 public:
  // The vehicle is one that validate() finds no fault with.
  Dynamics(const Vehicle& vehicle, const Supply& supply, Instructions instructions = Instructions::kBest);

  // From now on, until another is given.
  void disturb(const Disturbance& disturbance);

  // Brings the state forward by dt > 0 in as few equal Runge-Kutta steps as max_step_s() allows, with drive
  // and wind held.
  void advance(VehicleState& state, const RotorDrive& drive, const Eigen::Vector3d& wind_ned,
               double dt) const;

  // A third of the smallest of the time constants tau_a = L_a / R_a (with inductance), tau_m and the
  // battery's sag: RK4 is stable up to 2.7 of them, and off by less than 1e-4 of a transient at a third.
  double max_step_s() const { return max_step_s_; }

  // All forces but gravity, over mass: what an ideal accelerometer at the centre of mass measures in flight.
  Eigen::Vector3d specific_force_frd(const VehicleState& state, const Eigen::Vector3d& wind_ned) const;

  // At the battery's terminals, motors and electronics together.
  double supply_voltage(const VehicleState& state) const;
  double supply_current(const VehicleState& state, const RotorDrive& drive) const;

  // Armature currents that belong to these speeds when the voltages have stood for long against tau_a, i_a =
  // (v_a - e) / R_a.
  PerRotor settled_currents(const VehicleState& state, const RotorDrive& drive) const;

  int rotor_count() const { return rotor_count_; }

 private:
  template <int kRotors, MotorForm kMotor>
  struct Drivetrain;
  struct RigidBody;
  struct Wrench {
    Pair lift_roll = Pair::Zero();  // lift over the vehicle's mass, m/s^2, against body z; moment, N m
    Pair pitch_yaw = Pair::Zero();  // N m
  };
  // Open-circuit voltage as a straight line over the state of charge: that of the table's segment where a
  // step begins.
  struct OpenCircuit {
    double at_empty;  // V
    double slope;     // V

    double voltage(double state_of_charge) const { return at_empty + slope * state_of_charge; }
  };

  template <int kRotors, MotorForm kMotor>
  void advance_as(VehicleState& state, const RotorDrive& drive, const Eigen::Vector3d& wind_ned,
                  double dt) const;
  template <int kRotors, MotorForm kMotor>
  void advance_by_avx(VehicleState& state, const RotorDrive& drive, const Eigen::Vector3d& wind_ned,
                      double dt) const;
  template <int kRotors, MotorForm kMotor>
  void runge_kutta(VehicleState& state, const RotorDrive& drive, const Eigen::Vector3d& wind_ned,
                   double dt) const;
  OpenCircuit open_circuit(double state_of_charge) const;
  double armature_voltage(double supply_voltage_v, const RotorDrive& drive, std::size_t rotor) const;

  using Advance = void (Dynamics::*)(VehicleState&, const RotorDrive&, const Eigen::Vector3d&, double) const;
  template <int kRotors, MotorForm kMotor>
  static Advance choose(Instructions instructions);
  template <MotorForm kMotor>
  static Advance choose(int rotor_count, Instructions instructions);

  Advance advance_;
  int rotor_count_;
  double max_step_s_;

  double inverse_mass_;
  double drag_over_mass_;
  Symmetric inertia_;
  Symmetric inverse_inertia_;
  std::array<Wrench, kMaxRotors> sound_wrenches_;  // of each rotor, over Omega^2, without a disturbance
  std::array<Wrench, kMaxRotors> wrenches_;
  Eigen::Vector3d push_acceleration_ned_ = Eigen::Vector3d::Zero();
  Wrench push_;
  double supply_drop_v_ = 0.0;

  Esc esc_;
  MotorDynamics motor_;
  double inverse_electrical_time_;  // R_a / L_a
  // Eq. (22) solved: Omega_ss = sqrt(steady_square + steady_gain v_a) - steady_offset.
  double steady_offset_;
  double steady_square_;
  double steady_gain_;

  bool ideal_supply_;
  double ideal_voltage_;
  BatteryParameters battery_;               // of an ideal supply: one without resistance
  std::vector<OpenCircuit> open_circuits_;  // of each segment of its table
  double charge_per_current_;               // 1/(A s); 0 for an ideal supply
  double inverse_sag_time_;
};

}  // namespace swiftlet::plant
