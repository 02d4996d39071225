#include "swiftlet/plant/model/motor.hpp"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "swiftlet/plant/model/airframe.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::plant::motor_test {

using tests::kaylion;
using tests::UniformRandom;

Vehicle with_model(MotorModel model, double inductance_h = 0.0) {
  Vehicle vehicle = kaylion();
  vehicle.motor.model = model;
  vehicle.motor.armature_inductance_h = inductance_h;
  return vehicle;
}

// One classical Runge-Kutta step of y' = rate(y), y a double or a vector.
template <typename State, typename Rate>
State runge_kutta(const State& y, double dt, const Rate& rate) {
  const State k1 = rate(y);
  const State k2 = rate(State(y + 0.5 * dt * k1));
  const State k3 = rate(State(y + 0.5 * dt * k2));
  const State k4 = rate(State(y + dt * k3));
  return y + dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
}

// Time from rest to 1 - 1/e of the final speed after a step of voltage.
double rise_time(const MotorDynamics& dynamics, double voltage) {
  const double target = (1.0 - std::exp(-1.0)) * steady_speed_from_voltage(dynamics.motor, voltage);
  const double dt = 1e-5;
  double speed = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double next = runge_kutta(
        speed, dt, [&](double omega) { return speed_rate_from_voltage(dynamics, voltage, omega); });
    if (next >= target) return dt * (i + (target - speed) / (next - speed));
    speed = next;
  }
  return std::numeric_limits<double>::infinity();
}

TEST(Motor, SteadyStateMatchesEquation22) {
  const Motor& motor = kaylion().motor;
  EXPECT_DOUBLE_EQ(voltage_from_steady_speed(motor, 1600.0), 1.020e-3 * 1600.0 + 2.817e-7 * 1600.0 * 1600.0);
  const double v_a = 2.3;
  const double root = (-1.020e-3 + std::sqrt(1.020e-3 * 1.020e-3 + 4.0 * 2.817e-7 * v_a)) / (2.0 * 2.817e-7);
  EXPECT_NEAR(steady_speed_from_voltage(motor, v_a), root, 1e-9);
}

TEST(Motor, SteadySpeedInvertsVoltage) {
  UniformRandom draw;
  for (int i = 0; i < 1000; ++i) {
    const double speed = draw(0.0, 3000.0);
    EXPECT_NEAR(steady_speed_from_voltage(kaylion().motor, voltage_from_steady_speed(kaylion().motor, speed)),
                speed, 1e-9);
  }
  // Without cancellation: relative accuracy down to the smallest voltages.
  EXPECT_NEAR(steady_speed_from_voltage(kaylion().motor, 1e-12) / (1e-12 / 1.020e-3), 1.0, 1e-9);
}

TEST(Motor, TreatsNegativeInputAsZero) {
  EXPECT_EQ(voltage_from_steady_speed(kaylion().motor, -5.0), 0.0);
  EXPECT_EQ(steady_speed_from_voltage(kaylion().motor, -5.0), 0.0);
}

TEST(Motor, DerivedConstantsSatisfyEquation21) {
  const MotorDynamics d = motor_dynamics(kaylion());
  const double r_a = kaylion().motor.armature_resistance_ohm;
  EXPECT_NEAR((r_a * d.friction / d.torque_constant + d.torque_constant) / 1.020e-3, 1.0, 1e-12);
  EXPECT_NEAR((r_a * kaylion().rotor.torque / d.torque_constant) / 2.817e-7, 1.0, 1e-12);
  EXPECT_GE(d.friction, 0.0);
  EXPECT_NEAR(d.torque_constant * d.inverse_resistance, 6.611e-4, 1e-7);
}

TEST(Motor, AllModelsAreInEquilibriumAtTheSteadySpeed) {
  UniformRandom draw;
  for (int i = 0; i < 1000; ++i) {
    const double voltage = draw(0.1, 4.2);
    for (const MotorModel model : {MotorModel::kReduced, MotorModel::kPhysical}) {
      const MotorDynamics d = motor_dynamics(with_model(model, 5e-5));
      const double speed = steady_speed_from_voltage(d.motor, voltage);
      const double current = motor_current(d, voltage, speed);
      EXPECT_NEAR(speed_rate_from_voltage(d, voltage, speed), 0.0, 1e-7);
      EXPECT_NEAR(speed_rate_from_current(d, current, speed), 0.0, 1e-7);
      EXPECT_NEAR(motor_current_rate(d, voltage, current, speed), 0.0, 1e-7);
      EXPECT_GT(current, 0.0);
    }
  }
}

TEST(Motor, PhysicalFormsAgree) {
  // J_r dOmega/dt = (K1 / R_a) (v_a - K2 Omega - K3 Omega^2), from K1 i_a - F Omega - k_Q Omega^2.
  const MotorDynamics d = motor_dynamics(with_model(MotorModel::kPhysical));
  UniformRandom draw;
  for (int i = 0; i < 1000; ++i) {
    const double voltage = draw(0.0, 4.2);
    const double speed = draw(0.0, 2500.0);
    const double torque =
        kaylion().rotor.torque / 2.817e-7 * (voltage - 1.020e-3 * speed - 2.817e-7 * speed * speed);
    EXPECT_NEAR(speed_rate_from_voltage(d, voltage, speed), torque / d.rotor_inertia, 1e-7);
  }
}

TEST(Motor, ReducedModelRisesWithTheTimeConstant) {
  const MotorDynamics d = motor_dynamics(with_model(MotorModel::kReduced));
  for (const double voltage : {1.0, 2.37, 4.0}) EXPECT_NEAR(rise_time(d, voltage), 0.0821, 1e-6);
}

TEST(Motor, PhysicalModelRisesToHoverWithTheTimeConstant) {
  const Vehicle vehicle = with_model(MotorModel::kPhysical);
  const MotorDynamics d = motor_dynamics(vehicle);
  const double hover_voltage = voltage_from_steady_speed(d.motor, hover_speed(vehicle));
  EXPECT_NEAR(rise_time(d, hover_voltage), 0.0821, 1e-6);
  // More drag at higher speeds: larger steps are faster.
  EXPECT_GT(rise_time(d, 0.5 * hover_voltage), 0.0821);
  EXPECT_LT(rise_time(d, 1.7 * hover_voltage), 0.0821);
}

TEST(Motor, RotorInertiaFollowsHoverSpeedAndRiseTime) {
  for (const double mass : {0.03, 0.04, 0.06}) {
    for (const double tau : {0.02, 0.0821, 0.2}) {
      Vehicle vehicle = with_model(MotorModel::kPhysical);
      vehicle.mass_kg = mass;
      vehicle.motor.time_constant_s = tau;
      const MotorDynamics d = motor_dynamics(vehicle);
      EXPECT_NEAR(rise_time(d, voltage_from_steady_speed(d.motor, hover_speed(vehicle))), tau, 1e-6);
    }
  }
}

// Largest difference in speed between the model with an inductance and the one without, over a step of 0.2 s.
double inductance_error(double inductance_h) {
  const double voltage = 2.37;
  const MotorDynamics electrical = motor_dynamics(with_model(MotorModel::kPhysical, inductance_h));
  const MotorDynamics physical = motor_dynamics(with_model(MotorModel::kPhysical));
  EXPECT_TRUE(electrical.has_current_state());
  EXPECT_FALSE(physical.has_current_state());
  const double dt = 0.2 * inductance_h / electrical.motor.armature_resistance_ohm;
  Eigen::Vector2d state(0.0, 0.0);  // speed, current
  double speed = 0.0;
  double error = 0.0;
  const auto steps = static_cast<int>(std::ceil(0.2 / dt));
  for (int i = 0; i < steps; ++i) {
    state = runge_kutta(state, dt, [&](const Eigen::Vector2d& y) {
      return Eigen::Vector2d(speed_rate_from_current(electrical, y[1], y[0]),
                             motor_current_rate(electrical, voltage, y[1], y[0]));
    });
    speed = runge_kutta(speed, dt,
                        [&](double omega) { return speed_rate_from_voltage(physical, voltage, omega); });
    error = std::max(error, std::abs(state[0] - speed));
  }
  return error;
}

TEST(Motor, ElectricalModelConvergesToThePhysicalModel) {
  // The speed lags by tau_a = L_a / R_a: the error falls in proportion to L_a.
  const double coarse = inductance_error(4e-4);
  const double middle = inductance_error(4e-5);
  const double fine = inductance_error(4e-6);
  EXPECT_NEAR(coarse / middle, 10.0, 0.5);
  EXPECT_NEAR(middle / fine, 10.0, 0.5);
  EXPECT_LT(fine, 0.1);  // rad/s, of 1600
}

TEST(Motor, RotorsThatAreOffSlowDownAndStop) {
  for (const MotorModel model : {MotorModel::kReduced, MotorModel::kPhysical}) {
    const MotorDynamics d = motor_dynamics(with_model(model));
    double speed = 2000.0;
    for (int i = 0; i < 3000; ++i) {
      const double next =
          runge_kutta(speed, 1e-3, [&](double omega) { return speed_rate_from_voltage(d, 0.0, omega); });
      ASSERT_LT(next, speed);
      ASSERT_GE(next, 0.0);
      speed = next;
    }
    EXPECT_LT(speed, 0.1);
  }
}

TEST(Motor, DragOpposesRotationInBothDirections) {
  const MotorDynamics d = motor_dynamics(with_model(MotorModel::kPhysical));
  EXPECT_GT(speed_rate_from_current(d, 0.0, -100.0), 0.0);
  EXPECT_LT(speed_rate_from_current(d, 0.0, 100.0), 0.0);
}

}  // namespace swiftlet::plant::motor_test
