// Eq. (1)-(28) as one system of ordinary differential equations, integrated with the classical Runge-Kutta
// method of order 4. The state holds the rigid body (NED velocity, quaternion attitude), motors, rotors and
// battery.
//
//   dp/dt = v                                        Eq. (1)
//   m dv/dt = R F + m g z - c (v - wind)             Eq. (5), in NED; c is the vehicle's linear drag
//             - c_r sum(Omega) P (v - wind)          rotor drag: P projects on the plane of the rotors
//   dq/dt = q (0, w) / 2                             Eq. (2)-(4) without the Euler angles' singularity
//   J dw/dt = M - w x J w                            Eq. (6)
//   rotors                                           Eq. (9), (18) or (10)-(16), (25)-(28)
//   battery                                          vehicle.hpp, discharged by motors and electronics
#pragma once

#include <Eigen/Core>

#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/motor.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/vehicle_state.hpp"

namespace swiftlet::plant {

// Source of v_s of Eq. (9): the vehicle's battery or an ideal source of constant voltage.
struct Supply {
  bool ideal = false;
  double voltage_v = 0.0;  // V, of the ideal source

  static Supply battery() { return {}; }
  static Supply constant(double voltage_v) { return {true, voltage_v}; }
};

// External disturbances and degradations of a vehicle.
struct Disturbance {
  Eigen::Vector3d force_ned = Eigen::Vector3d::Zero();                // N, at the centre of mass
  Eigen::Vector3d moment_frd = Eigen::Vector3d::Zero();               // N m
  double supply_drop_v = 0.0;                                         // V, drop of the open-circuit voltage
  PerRotor rotor_factors = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};  // factors of thrust and torque
};

// Effects of the air on the rotors that the paper leaves out.
struct RotorAir {
  double drag =
      0.0;  // c_r, N s^2/m (Martin and Salaun, "The true role of accelerometer feedback in quadrotor control", 2010)
  double radius_m = 0.0;     // of the rotors in ground effect (rotor.hpp); 0: none
  double floor_z_ned = 0.0;  // m
};

class Dynamics {
 public:
  // Precondition: validate(vehicle) is empty.
  Dynamics(const Vehicle& vehicle, const Supply& supply, const RotorAir& rotor_air = {});

  // Sets the disturbance that acts until the next call.
  void disturb(const Disturbance& disturbance) { disturbance_ = disturbance; }

  // Integrates the state over dt > 0, s, in the fewest equal Runge-Kutta steps not above max_step_s(). The
  // motor command and the wind are constant over dt.
  void advance(VehicleState& state, const MotorCommand& drive, const Eigen::Vector3d& wind_ned,
               double dt) const;

  // Largest integration step: a third of the smallest of the time constants tau_a = L_a / R_a (with
  // inductance), tau_m and the battery's sag. RK4 is stable up to 2.7 time constants; at a third its error is
  // below 1e-4 of a transient.
  double max_step_s() const { return max_step_s_; }

  // Specific force, m/s^2: all forces except gravity and ground contact, over the mass. An ideal
  // accelerometer at the centre of mass measures this in flight.
  Eigen::Vector3d specific_force_frd(const VehicleState& state, const Eigen::Vector3d& wind_ned) const;

  // Voltage, V, and current, A, at the battery terminals. The current is that of motors and electronics
  // together.
  double supply_voltage(const VehicleState& state) const;
  double supply_current(const VehicleState& state, const MotorCommand& drive) const;

  // Steady armature currents, A, at the state's rotor speeds: i_a = (v_a - e) / R_a with back-EMF e, reached
  // when the voltages are constant for a time much longer than tau_a.
  PerRotor settled_currents(const VehicleState& state, const MotorCommand& drive) const;

  int rotor_count() const { return rotor_count_; }

 private:
  // State vector in the order pack() writes: position, velocity, quaternion (x, y, z, w), body rates, state
  // of charge, sag, rotor speeds, armature currents.
  using State = Eigen::Matrix<double, 15 + 2 * kMaxRotors, 1>;
  using Rotors = Eigen::Matrix<double, kMaxRotors, 1>;

  // Open-circuit voltage as a linear function of the state of charge: the segment of the table in which a
  // step begins.
  struct OpenCircuit {
    double at_empty;  // V, at state of charge 0
    double slope;     // V per unit state of charge

    double voltage(double state_of_charge) const { return at_empty + slope * state_of_charge; }
  };

  static State pack(const VehicleState& state);
  static void unpack(const State& x, VehicleState& state);
  State derivative(const State& x, const MotorCommand& drive, const Eigen::Vector3d& wind_ned,
                   const OpenCircuit& open_circuit) const;
  OpenCircuit open_circuit(double state_of_charge) const;

  double armature_voltage(double supply_voltage_v, const MotorCommand& drive, int rotor) const;
  double supply_current(double supply_voltage_v, double power_w) const;
  // Thrust along -z of FRD, N, and roll, pitch and yaw moment, N m, of one rotor, free of the ground.
  Eigen::Vector4d rotor_wrench(int rotor, double speed) const;
  // Factor of thrust, roll and pitch moment near the ground; z_ned: of the vehicle's origin.
  double ground_effect_at(double z_ned) const;
  // Drag and disturbance force, N. speed_sum: of all rotors, rad/s.
  Eigen::Vector3d air_force_ned(const Eigen::Vector3d& velocity_ned, const Eigen::Vector3d& wind_ned,
                                const Eigen::Vector3d& body_z_ned, double speed_sum) const;

  int rotor_count_;
  double inverse_mass_;
  Eigen::Matrix3d inertia_;
  Eigen::Matrix3d inverse_inertia_;
  double linear_drag_;  // N s/m
  RotorAir rotor_air_;
  Effectiveness effectiveness_;
  RotorCoefficients rotor_;
  Esc esc_;
  MotorDynamics motor_;
  BatteryParameters battery_;
  double max_step_s_;
  Disturbance disturbance_;
};

}  // namespace swiftlet::plant
