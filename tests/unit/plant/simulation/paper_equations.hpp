// An independent implementation of the paper's equations, as printed and with the paper's numbers: body
// velocities, a rotation matrix, an embedded Runge-Kutta pair of order 7(8) at 1e-10.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <boost/numeric/odeint.hpp>

#include "swiftlet/plant/simulation/vehicle_state.hpp"

namespace swiftlet::tests::paper {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;

inline constexpr std::array<const char*, 22> kNames = {
    "x",   "y",   "z",   "u",   "v", "w", "R11", "R21",    "R31",    "R12",    "R22",
    "R32", "R13", "R23", "R33", "p", "q", "r",   "Omega1", "Omega2", "Omega3", "Omega4"};
using State = std::vector<double>;

enum class Motor { kReduced, kPhysical };

constexpr double kGravity = 9.80665;
constexpr double kMass = 0.040;

// The right-hand side; R_a, K_1 and J_r enter through K_1 / (R_a J_r) only.
struct Equations {
  Matrix3d inertia;
  Motor motor;
  double supply_voltage;
  bool running = false;
  std::array<double, 4> throttle{};

  static constexpr double kThrust = 3.7901e-8;
  static constexpr double kTorque = 1.8623e-10;
  static constexpr double kTimeConstant = 0.0821;
  static constexpr double kK2 = 1.020e-3;
  static constexpr double kK3 = 2.817e-7;

  // Eq. (9); no voltage at all for rotors that are off.
  double motor_voltage(std::size_t i) const {
    return running ? std::sqrt(0.9205 * supply_voltage * supply_voltage * throttle[i] + 0.6472) : 0.0;
  }

  // K_1 / (R_a J_r). From rest at the voltage that holds Omega_h,
  // J_r dOmega/dt = (K_1 / R_a) K_3 (Omega_h - Omega) (Omega + c), c = Omega_h + K_2 / K_3, takes
  // R_a J_r / (K_1 K_3 (Omega_h + c)) ln((Omega + c) / c * Omega_h / (Omega_h - Omega)) to Omega: tau_m to
  // (1 - 1/e) Omega_h.
  static double physical_gain() {
    const double hover = std::sqrt(kMass * kGravity / 4.0 / kThrust);
    const double c = hover + kK2 / kK3;
    const double reached = (1.0 - std::exp(-1.0)) * hover;
    return std::log((reached + c) / c * hover / (hover - reached)) / (kK3 * (hover + c)) / kTimeConstant;
  }

  void operator()(const State& s, State& ds, double /*t*/) const {
    const Vector3d body_velocity(s[3], s[4], s[5]);
    const Matrix3d rotation = Eigen::Map<const Matrix3d>(&s[6]);
    const Vector3d rates(s[15], s[16], s[17]);

    // Eq. (25), (26), (27), (28)
    Vector4d thrust;
    Vector4d torque;
    for (int i = 0; i < 4; ++i) {
      const double speed = s[18 + static_cast<std::size_t>(i)];
      thrust[i] = kThrust * speed * speed;
      torque[i] = kTorque * speed * speed;
    }
    const double d = 0.0695 / std::sqrt(2.0);
    const Vector3d force(0.0, 0.0, -thrust.sum());
    const Vector3d moment(d * (-thrust[0] + thrust[1] + thrust[2] - thrust[3]),
                          d * (thrust[0] + thrust[1] - thrust[2] - thrust[3]),
                          torque[0] - torque[1] + torque[2] - torque[3]);

    const Vector3d position_rate = rotation * body_velocity;  // Eq. (1)
    // Eq. (5)
    const Vector3d velocity_rate =
        (force + rotation.transpose() * Vector3d(0.0, 0.0, kMass * kGravity)) / kMass -
        rates.cross(body_velocity);
    // dR/dt = R [w]x, Eq. (2)-(4) without Euler angles
    Matrix3d cross;
    cross << 0.0, -rates.z(), rates.y(), rates.z(), 0.0, -rates.x(), -rates.y(), rates.x(), 0.0;
    const Matrix3d rotation_rate = rotation * cross;
    // Eq. (6)
    const Vector3d angular_acceleration = inertia.inverse() * (moment - rates.cross(inertia * rates));

    for (std::size_t i = 0; i < 3; ++i) {
      const auto j = static_cast<Eigen::Index>(i);
      ds[i] = position_rate[j];
      ds[3 + i] = velocity_rate[j];
      ds[15 + i] = angular_acceleration[j];
    }
    Eigen::Map<Matrix3d>{&ds[6]} = rotation_rate;
    for (std::size_t i = 0; i < 4; ++i) {
      const double speed = s[18 + i];
      const double v_a = motor_voltage(i);
      if (motor == Motor::kReduced) {  // Eq. (18), (22)
        const double steady = (-kK2 + std::sqrt(kK2 * kK2 + 4.0 * kK3 * v_a)) / (2.0 * kK3);
        ds[18 + i] = (steady - speed) / kTimeConstant;
      } else {  // Eq. (10), (15) with L_a = 0
        ds[18 + i] = physical_gain() * (v_a - kK2 * speed - kK3 * speed * speed);
      }
    }
  }
};

inline State state_of(const plant::VehicleState& state) {
  State s(kNames.size());
  const Matrix3d rotation = state.q_ned_from_frd.toRotationMatrix();
  const Vector3d body_velocity = rotation.transpose() * state.velocity_ned;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto j = static_cast<Eigen::Index>(i);
    s[i] = state.position_ned[j];
    s[3 + i] = body_velocity[j];
    s[15 + i] = state.body_rates_frd[j];
  }
  Eigen::Map<Matrix3d>{&s[6]} = rotation;
  for (std::size_t i = 0; i < 4; ++i) s[18 + i] = state.rotor_speeds[i];
  return s;
}

// Integrates the state from one time to another, in s, with constant commands.
inline void integrate(const Equations& equations, State& state, double from, double to) {
  namespace odeint = boost::numeric::odeint;
  odeint::integrate_adaptive(
      odeint::make_controlled(1.0e-10, 1.0e-10, odeint::runge_kutta_fehlberg78<State>()), equations, state,
      from, to, 1.0e-4);
}

// The largest difference and the largest value of each quantity over a motion.
struct Comparison {
  State worst = State(kNames.size());
  State peak = State(kNames.size());

  void add(const State& reference, const State& simulated) {
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      peak[i] = std::max(peak[i], std::abs(reference[i]));
      worst[i] = std::max(worst[i], std::abs(simulated[i] - reference[i]));
    }
  }
};

}  // namespace swiftlet::tests::paper
