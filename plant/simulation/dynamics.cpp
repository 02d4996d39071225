#include "swiftlet/plant/simulation/dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "swiftlet/plant/model/battery.hpp"
#include "swiftlet/plant/model/esc.hpp"
#include "swiftlet/plant/model/rotor.hpp"

namespace swiftlet::plant {

namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kStepPerTimeConstant = 1.0 / 3.0;  // largest step over the shortest time constant

// Indices of the first element of each part of the state vector.
constexpr int kPosition = 0;
constexpr int kVelocity = 3;
constexpr int kAttitude = 6;
constexpr int kBodyRates = 10;
constexpr int kCharge = 13;
constexpr int kSag = 14;
constexpr int kRotorSpeeds = 15;
constexpr int kCurrents = kRotorSpeeds + kMaxRotors;

// Third column of R_{n/b}, Eq. (3), from the quaternion: the body's z axis in NED.
Vector3d body_z_ned(const Quaterniond& q) {
  return {2.0 * (q.x() * q.z() + q.w() * q.y()), 2.0 * (q.y() * q.z() - q.w() * q.x()),
          q.w() * q.w() - q.x() * q.x() - q.y() * q.y() + q.z() * q.z()};
}

// Battery of constant voltage: no resistance, unlimited capacity.
BatteryParameters ideal_battery(BatteryParameters battery, double voltage_v) {
  battery.state_of_charge = {0.0, 1.0};
  battery.open_circuit_voltage_v = {voltage_v, voltage_v};
  battery.internal_resistance_ohm = 0.0;
  battery.capacity_ah = std::numeric_limits<double>::infinity();
  return battery;
}

}  // namespace

Dynamics::Dynamics(const Vehicle& vehicle, const Supply& supply, const RotorAir& rotor_air)
    : rotor_count_(vehicle.rotor_count()),
      inverse_mass_(1.0 / vehicle.mass_kg),
      inertia_(vehicle.inertia),
      inverse_inertia_(vehicle.inertia.inverse()),
      linear_drag_(vehicle.linear_drag),
      rotor_air_(rotor_air),
      effectiveness_(effectiveness(vehicle)),
      rotor_(vehicle.rotor),
      esc_(vehicle.esc),
      motor_(motor_dynamics(vehicle)),
      battery_(supply.ideal ? ideal_battery(vehicle.battery, supply.voltage_v) : vehicle.battery) {
  double shortest_s = vehicle.motor.time_constant_s;
  if (!supply.ideal) shortest_s = std::min(shortest_s, battery_.sag_time_constant_s);
  if (motor_.has_current_state()) {
    shortest_s =
        std::min(shortest_s, vehicle.motor.armature_inductance_h / vehicle.motor.armature_resistance_ohm);
  }
  max_step_s_ = kStepPerTimeConstant * shortest_s;
}

// Eq. (9). The voltage of a rotor that is off is 0.
inline double Dynamics::armature_voltage(double supply_voltage_v, const MotorCommand& drive,
                                         int rotor) const {
  if (drive.state != RotorState::kRunning) return 0.0;
  return motor_voltage(esc_, supply_voltage_v, drive.throttle[static_cast<std::size_t>(rotor)]);
}

// The ESCs have no losses (esc.hpp): power_w is both what they draw and what the motors take.
inline double Dynamics::supply_current(double supply_voltage_v, double power_w) const {
  return battery_.electronics_current_a + (supply_voltage_v > 0.0 ? power_w / supply_voltage_v : 0.0);
}

// Eq. (25)-(28)
inline Vector4d Dynamics::rotor_wrench(int rotor, double speed) const {
  const double factor = disturbance_.rotor_factors[static_cast<std::size_t>(rotor)];
  return factor * thrust_from_speed(rotor_, speed) * effectiveness_.col(rotor);
}

inline double Dynamics::ground_effect_at(double z_ned) const {
  return rotor_air_.radius_m > 0.0 ? ground_effect(rotor_air_.radius_m, rotor_air_.floor_z_ned - z_ned) : 1.0;
}

inline Vector3d Dynamics::air_force_ned(const Vector3d& velocity_ned, const Vector3d& wind_ned,
                                        const Vector3d& body_z_ned, double speed_sum) const {
  const Vector3d relative = velocity_ned - wind_ned;
  const Vector3d force = disturbance_.force_ned - linear_drag_ * relative;
  if (rotor_air_.drag == 0.0) return force;
  return force - rotor_air_.drag * speed_sum * (relative - relative.dot(body_z_ned) * body_z_ned);
}

Dynamics::State Dynamics::derivative(const State& x, const MotorCommand& drive, const Vector3d& wind_ned,
                                     const OpenCircuit& open_circuit) const {
  State dx = State::Zero();

  // Battery, ESCs, motors, rotors
  const double v_s = std::max(open_circuit.voltage(x[kCharge]) - x[kSag], 0.0);
  double power_w = 0.0;
  double speed_sum = 0.0;
  Vector4d wrench = Vector4d::Zero();
  for (int i = 0; i < rotor_count_; ++i) {
    const double omega = x[kRotorSpeeds + i];
    const double v_a = armature_voltage(v_s, drive, i);  // Eq. (9)
    double i_a = motor_current(motor_, v_a, omega);      // Eq. (10) with L_a = 0
    if (motor_.has_current_state()) {
      i_a = x[kCurrents + i];
      dx[kCurrents + i] = motor_current_rate(motor_, v_a, i_a, omega);     // Eq. (10)
      dx[kRotorSpeeds + i] = speed_rate_from_current(motor_, i_a, omega);  // Eq. (15)
    } else {
      dx[kRotorSpeeds + i] = speed_rate_from_voltage(motor_, v_a, omega);  // Eq. (18), or (10) and (15)
    }
    power_w += std::max(v_a * i_a, 0.0);
    wrench += rotor_wrench(i, omega);  // Eq. (25)-(28)
    speed_sum += omega;
  }
  if (rotor_air_.radius_m > 0.0) wrench.head<3>() *= ground_effect_at(x[kPosition + 2]);
  const double i_s = supply_current(v_s, power_w);
  dx[kCharge] = state_of_charge_rate(battery_, i_s);
  dx[kSag] = sag_rate(battery_, i_s, x[kSag]);

  // Rigid body
  const Vector3d v = x.segment<3>(kVelocity);
  const Quaterniond q(x.segment<4>(kAttitude));
  const Vector3d w = x.segment<3>(kBodyRates);
  const Vector3d body_z = body_z_ned(q);
  const Vector3d f_ned =
      air_force_ned(v, wind_ned, body_z, speed_sum) - wrench[0] * body_z;  // R F of Eq. (27), drag
  const Vector3d m = wrench.tail<3>() + disturbance_.moment_frd;           // M of Eq. (28)
  const Vector3d g(0.0, 0.0, kGravity);
  dx.segment<3>(kPosition) = v;                                                           // Eq. (1)
  dx.segment<3>(kVelocity) = inverse_mass_ * f_ned + g;                                   // Eq. (5)
  dx.segment<4>(kAttitude) = 0.5 * (q * Quaterniond(0.0, w.x(), w.y(), w.z())).coeffs();  // Eq. (2)
  dx.segment<3>(kBodyRates) = inverse_inertia_ * (m - w.cross(inertia_ * w));             // Eq. (6)
  return dx;
}

void Dynamics::advance(VehicleState& state, const MotorCommand& drive, const Vector3d& wind_ned,
                       double dt) const {
  const int steps = dt <= max_step_s_ ? 1 : static_cast<int>(std::ceil(dt / max_step_s_));
  const double h = dt / steps;
  const OpenCircuit v_oc = open_circuit(state.state_of_charge);
  State x = pack(state);
  for (int i = 0; i < steps; ++i) {
    const State k1 = derivative(x, drive, wind_ned, v_oc);
    const State k2 = derivative(x + h / 2 * k1, drive, wind_ned, v_oc);
    const State k3 = derivative(x + h / 2 * k2, drive, wind_ned, v_oc);
    const State k4 = derivative(x + h * k3, drive, wind_ned, v_oc);
    x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  unpack(x, state);
}

Dynamics::OpenCircuit Dynamics::open_circuit(double state_of_charge) const {
  const std::vector<double>& charge = battery_.state_of_charge;
  const std::vector<double>& voltage = battery_.open_circuit_voltage_v;
  if (state_of_charge <= charge.front()) return {voltage.front() - disturbance_.supply_drop_v, 0.0};
  std::size_t end = charge.size() - 1;
  while (end > 1 && state_of_charge <= charge[end - 1]) --end;
  const double slope = (voltage[end] - voltage[end - 1]) / (charge[end] - charge[end - 1]);
  return {voltage[end] - slope * charge[end] - disturbance_.supply_drop_v, slope};
}

double Dynamics::supply_voltage(const VehicleState& state) const {
  return std::max(open_circuit(state.state_of_charge).voltage(state.state_of_charge) - state.sag_v, 0.0);
}

double Dynamics::supply_current(const VehicleState& state, const MotorCommand& drive) const {
  const double v_s = supply_voltage(state);
  const PerRotor currents_a =
      motor_.has_current_state() ? state.armature_currents : settled_currents(state, drive);
  double power_w = 0.0;
  for (int i = 0; i < rotor_count_; ++i) {
    power_w += std::max(armature_voltage(v_s, drive, i) * currents_a[static_cast<std::size_t>(i)], 0.0);
  }
  return supply_current(v_s, power_w);
}

PerRotor Dynamics::settled_currents(const VehicleState& state, const MotorCommand& drive) const {
  const double v_s = supply_voltage(state);
  PerRotor currents_a{};
  for (int i = 0; i < rotor_count_; ++i) {
    const auto n = static_cast<std::size_t>(i);
    currents_a[n] = motor_current(motor_, armature_voltage(v_s, drive, i), state.rotor_speeds[n]);
  }
  return currents_a;
}

Vector3d Dynamics::specific_force_frd(const VehicleState& state, const Vector3d& wind_ned) const {
  double thrust_n = 0.0;
  double speed_sum = 0.0;
  for (int i = 0; i < rotor_count_; ++i) {
    const double omega = state.rotor_speeds[static_cast<std::size_t>(i)];
    thrust_n += rotor_wrench(i, omega)[0];
    speed_sum += omega;
  }
  thrust_n *= ground_effect_at(state.position_ned.z());
  const Vector3d f = -thrust_n * Vector3d::UnitZ();
  const Vector3d air_ned =
      air_force_ned(state.velocity_ned, wind_ned, body_z_ned(state.q_ned_from_frd), speed_sum);
  return inverse_mass_ * (f + state.q_ned_from_frd.conjugate() * air_ned);
}

Dynamics::State Dynamics::pack(const VehicleState& state) {
  State x;
  x << state.position_ned, state.velocity_ned, state.q_ned_from_frd.coeffs(), state.body_rates_frd,
      state.state_of_charge, state.sag_v, Rotors::Map(state.rotor_speeds.data()),
      Rotors::Map(state.armature_currents.data());
  return x;
}

void Dynamics::unpack(const State& x, VehicleState& state) {
  state.position_ned = x.segment<3>(kPosition);
  state.velocity_ned = x.segment<3>(kVelocity);
  state.q_ned_from_frd = Quaterniond(x.segment<4>(kAttitude)).normalized();
  state.body_rates_frd = x.segment<3>(kBodyRates);
  state.state_of_charge = std::max(x[kCharge], 0.0);
  state.sag_v = x[kSag];
  Rotors::Map(state.rotor_speeds.data()) = x.segment<kMaxRotors>(kRotorSpeeds);
  Rotors::Map(state.armature_currents.data()) = x.segment<kMaxRotors>(kCurrents);
}

}  // namespace swiftlet::plant
