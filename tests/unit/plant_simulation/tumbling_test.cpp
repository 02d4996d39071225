// The simulated vehicle against the paper's equations, written down a second time as they are printed, with
// the paper's numbers, and integrated by another method: body velocities, a rotation matrix, an embedded
// Runge-Kutta pair of order 7(8) at 1e-10.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <boost/numeric/odeint.hpp>
#include <gtest/gtest.h>

#include "plant/simulation/plant_simulation.hpp"
#include "tests/unit/plant_model/vehicles.hpp"
#include "tests/unit/plant_simulation/worlds.hpp"

namespace swiftlet::tests {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr std::array<const char*, 22> kNames = {
    "x",   "y",   "z",   "u",   "v", "w", "R11", "R21",    "R31",    "R12",    "R22",
    "R32", "R13", "R23", "R33", "p", "q", "r",   "Omega1", "Omega2", "Omega3", "Omega4"};
using State = std::vector<double>;

enum class Motor { kReduced, kPhysical };

constexpr double kGravity = 9.80665;
constexpr double kMass = 0.040;
constexpr double kSupplyVoltage = 4.19;

// The right-hand side; R_a, K_1 and J_r enter through K_1 / (R_a J_r) only.
struct PaperEquations {
  Matrix3d inertia;
  Motor motor;
  bool running = false;
  std::array<double, 4> throttle{};

  static constexpr double kThrust = 3.7901e-8;
  static constexpr double kTorque = 1.8623e-10;
  static constexpr double kTimeConstant = 0.0821;
  static constexpr double kK2 = 1.020e-3;
  static constexpr double kK3 = 2.817e-7;

  // Eq. (9); no voltage at all for rotors that are off.
  double motor_voltage(std::size_t i) const {
    return running ? std::sqrt(0.9205 * kSupplyVoltage * kSupplyVoltage * throttle[i] + 0.6472) : 0.0;
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
    // dR/dt = R [w]x, which Eq. (2)-(4) say in Euler angles
    Matrix3d cross;
    cross << 0.0, -rates.z(), rates.y(), rates.z(), 0.0, -rates.x(), -rates.y(), rates.x(), 0.0;
    const Matrix3d rotation_rate = rotation * cross;
    // Eq. (6)
    const Vector3d angular_acceleration = inertia.ldlt().solve(moment - rates.cross(inertia * rates));

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

State paper_state(const plant::VehicleState& state) {
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

Vector3d random_vector(Draw& draw, double length) {
  Vector3d v;
  do {
    v = Vector3d(draw(-1, 1), draw(-1, 1), draw(-1, 1));
  } while (v.norm() > 1.0);
  return length * v;
}

plant::VehicleState random_tumble(Draw& draw) {
  plant::VehicleState state;
  state.position_ned = random_vector(draw, 2.0);
  state.velocity_ned = random_vector(draw, 3.0);
  state.q_ned_from_frd = Eigen::Quaterniond(draw(-1, 1), draw(-1, 1), draw(-1, 1), draw(-1, 1)).normalized();
  state.body_rates_frd = random_vector(draw, 15.0);
  for (std::size_t i = 0; i < 4; ++i) state.rotor_speeds[i] = draw(0.0, 2300.0);
  return state;
}

// Flies 2 s with commands that change every 3 .. 80 ms, and compares at each change. Every quantity must agree
// within tolerance of the largest value that it takes in the flight.
void compare(const plant::Vehicle& vehicle, Motor motor, Draw& draw, double tolerance) {
  namespace odeint = boost::numeric::odeint;
  constexpr int kSteps = 2000;

  const plant::VehicleState initial = random_tumble(draw);
  plant::PlantSimulation plant(vehicle, empty_space(), 1, initial);
  PaperEquations equations{vehicle.inertia, motor};
  State reference = paper_state(initial);

  State peak(kNames.size());
  State worst(kNames.size());
  double fastest = 0.0;
  for (int now = 0; now < kSteps;) {
    const int until = std::min(now + static_cast<int>(draw(3, 80)), kSteps);
    plant::RotorDrive drive;
    equations.running = draw(0, 1) > 0.1;
    drive.state = equations.running ? plant::RotorState::kRunning : plant::RotorState::kOff;
    for (std::size_t i = 0; i < 4; ++i) {
      equations.throttle[i] = std::clamp(draw(-0.2, 0.9), 0.0, 1.0);
      drive.throttle[i] = equations.throttle[i];
    }
    odeint::integrate_adaptive(
        odeint::make_controlled(1.0e-10, 1.0e-10, odeint::runge_kutta_fehlberg78<State>()), equations,
        reference, now * 1.0e-3, until * 1.0e-3, 1.0e-4);
    for (; now < until; ++now) plant.step(drive);

    const State simulated = paper_state(plant.state());
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      peak[i] = std::max(peak[i], std::abs(reference[i]));
      worst[i] = std::max(worst[i], std::abs(simulated[i] - reference[i]));
    }
    fastest = std::max(fastest, plant.state().body_rates_frd.norm());
  }
  EXPECT_EQ(plant.stamp_ns(), 2'000'000'000);
  EXPECT_GT(fastest, 3.0) << "not much of a tumble";
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    EXPECT_LT(worst[i], tolerance * peak[i]) << kNames[i] << " reaches " << peak[i];
  }
}

TEST(Tumbling, AgreesWithThePaperReducedMotor) {
  Draw draw;
  for (int flight = 0; flight < 10; ++flight) {
    SCOPED_TRACE("flight " + std::to_string(flight));
    compare(kaylion(), Motor::kReduced, draw, 1.0e-5);
  }
}

TEST(Tumbling, AgreesWithThePaperPhysicalMotor) {
  plant::Vehicle vehicle = kaylion();
  vehicle.motor.model = plant::MotorModel::kPhysical;
  Draw draw;
  for (int flight = 0; flight < 10; ++flight) {
    SCOPED_TRACE("flight " + std::to_string(flight));
    compare(vehicle, Motor::kPhysical, draw, 1.0e-5);
  }
}

TEST(Tumbling, AgreesWithThePaperProductsOfInertia) {
  plant::Vehicle vehicle = kaylion();
  vehicle.inertia << 4.4e-5, 3.0e-6, -2.0e-6, 3.0e-6, 5.5e-5, 4.0e-6, -2.0e-6, 4.0e-6, 8.8e-5;
  ASSERT_TRUE(plant::validate(vehicle).empty());
  Draw draw;
  for (int flight = 0; flight < 10; ++flight) {
    SCOPED_TRACE("flight " + std::to_string(flight));
    compare(vehicle, Motor::kReduced, draw, 1.0e-5);
  }
}

}  // namespace
}  // namespace swiftlet::tests
