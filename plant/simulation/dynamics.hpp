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

#include <Eigen/Core>

#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/motor.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
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

class Dynamics {
 public:
  // The vehicle is one that validate() finds no fault with.
  Dynamics(const Vehicle& vehicle, const Supply& supply);

  // From now on, until another is given.
  void disturb(const Disturbance& disturbance) { disturbance_ = disturbance; }

  // Brings the state forward by dt > 0 in as few equal Runge-Kutta steps as max_step_s() allows, with drive
  // and wind held.
  void advance(VehicleState& state, const MotorCommand& drive, const Eigen::Vector3d& wind_ned,
               double dt) const;

  // A third of the smallest of the time constants tau_a = L_a / R_a (with inductance), tau_m and the
  // battery's sag: RK4 is stable up to 2.7 of them, and off by less than 1e-4 of a transient at a third.
  double max_step_s() const { return max_step_s_; }

  // All forces but gravity, over mass: what an ideal accelerometer at the centre of mass measures in flight.
  Eigen::Vector3d specific_force_frd(const VehicleState& state, const Eigen::Vector3d& wind_ned) const;

  // At the battery's terminals, motors and electronics together.
  double supply_voltage(const VehicleState& state) const;
  double supply_current(const VehicleState& state, const MotorCommand& drive) const;

  // Armature currents that belong to these speeds when the voltages have stood for long against tau_a, i_a =
  // (v_a - e) / R_a.
  PerRotor settled_currents(const VehicleState& state, const MotorCommand& drive) const;

  int rotor_count() const { return rotor_count_; }

 private:
  // All that is integrated, in the order of VehicleState; the quaternion as (x, y, z, w).
  using State = Eigen::Matrix<double, 15 + 2 * kMaxRotors, 1>;
  using Rotors = Eigen::Matrix<double, kMaxRotors, 1>;

  // Open-circuit voltage as a straight line over the state of charge: that of the table's segment where a step
  // begins.
  struct OpenCircuit {
    double at_empty;  // V
    double slope;     // V

    double voltage(double state_of_charge) const { return at_empty + slope * state_of_charge; }
  };

  static State pack(const VehicleState& state);
  static void unpack(const State& x, VehicleState& state);
  State derivative(const State& x, const MotorCommand& drive, const Eigen::Vector3d& wind_ned,
                   const OpenCircuit& open_circuit) const;
  OpenCircuit open_circuit(double state_of_charge) const;

  double armature_voltage(double supply_voltage_v, const MotorCommand& drive, int rotor) const;
  double supply_current(double supply_voltage_v, double power_w) const;
  // Thrust along -z of FRD, N, and moments, N m.
  Eigen::Vector4d rotor_wrench(int rotor, double speed) const;
  // Drag and push, N.
  Eigen::Vector3d air_force_ned(const Eigen::Vector3d& velocity_ned, const Eigen::Vector3d& wind_ned) const;

  int rotor_count_;
  double inverse_mass_;
  Eigen::Matrix3d inertia_;
  Eigen::Matrix3d inverse_inertia_;
  double linear_drag_;  // N s/m
  Effectiveness effectiveness_;
  RotorCoefficients rotor_;
  Esc esc_;
  MotorDynamics motor_;
  BatteryParameters battery_;
  double max_step_s_;
  Disturbance disturbance_;
};

}  // namespace swiftlet::plant
