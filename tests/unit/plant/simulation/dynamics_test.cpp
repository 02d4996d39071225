// Properties of the dynamics: order, invariants, equilibria, time constants.
#include "swiftlet/plant/simulation/dynamics.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/battery.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "tests/unit/plant/model/vehicles.hpp"
#include "tests/unit/plant/simulation/worlds.hpp"

namespace swiftlet::tests::dynamics_test {

using Eigen::Vector3d;
using plant::Dynamics;
using plant::MotorCommand;
using plant::Supply;
using plant::Vehicle;
using plant::VehicleState;

const Vector3d kStillAir = Vector3d::Zero();

void fly(const Dynamics& dynamics, VehicleState& state, const MotorCommand& command, double duration_s,
         int steps, const Vector3d& wind_ned = kStillAir) {
  for (int i = 0; i < steps; ++i) dynamics.advance(state, command, wind_ned, duration_s / steps);
}

VehicleState hovering(const Vehicle& vehicle) {
  VehicleState state;
  for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) state.rotor_speeds[i] = plant::hover_speed(vehicle);
  return state;
}

VehicleState tumbling() {
  VehicleState state;
  state.velocity_ned = {1.0, -2.0, 0.5};
  state.q_ned_from_frd = Eigen::Quaterniond(0.5, -0.3, 0.7, 0.2).normalized();
  state.body_rates_frd = {9.0, -7.0, 5.0};
  state.rotor_speeds = {500.0, 1900.0, 1200.0, 800.0};
  return state;
}

double distance(const VehicleState& a, const VehicleState& b) {
  double speeds = 0.0;
  for (std::size_t i = 0; i < a.rotor_speeds.size(); ++i)
    speeds = std::max(speeds, std::abs(a.rotor_speeds[i] - b.rotor_speeds[i]));
  return (a.position_ned - b.position_ned).norm() + (a.velocity_ned - b.velocity_ned).norm() +
         (a.q_ned_from_frd.coeffs() - b.q_ned_from_frd.coeffs()).norm() +
         (a.body_rates_frd - b.body_rates_frd).norm() + 1.0e-3 * speeds + std::abs(a.sag_v - b.sag_v) +
         std::abs(a.state_of_charge - b.state_of_charge);
}

class EveryMotor : public testing::TestWithParam<plant::MotorModel> {};

TEST_P(EveryMotor, HalvingTheStepDividesTheErrorBySixteen) {
  Vehicle vehicle = kaylion();
  vehicle.motor.model = GetParam();
  const Dynamics dynamics(vehicle, Supply::battery());
  MotorCommand command = running(0.4);
  command.throttle[1] = 0.7;
  const auto end = [&](int steps) {
    VehicleState state = tumbling();
    state.state_of_charge = 0.95;  // far from the ends of the table's segment
    fly(dynamics, state, command, 0.4, steps);
    return state;
  };
  const VehicleState exact = end(12800);
  const double coarse = distance(end(200), exact);
  const double fine = distance(end(400), exact);
  const double finer = distance(end(800), exact);
  EXPECT_NEAR(coarse / fine, 16.0, 2.0);
  EXPECT_NEAR(fine / finer, 16.0, 2.0);
}

INSTANTIATE_TEST_SUITE_P(Dynamics, EveryMotor,
                         testing::Values(plant::MotorModel::kReduced, plant::MotorModel::kPhysical));

TEST(Dynamics, TorqueFreeRotationKeepsEnergyAndAngularMomentum) {
  Vehicle vehicle = kaylion();
  vehicle.inertia << 4.4e-5, 3.0e-6, -2.0e-6, 3.0e-6, 5.5e-5, 4.0e-6, -2.0e-6, 4.0e-6, 8.8e-5;
  const Dynamics dynamics(vehicle, Supply::constant(4.0));
  VehicleState state = tumbling();
  state.rotor_speeds = {};
  const auto momentum = [&] {
    return Vector3d(state.q_ned_from_frd * (vehicle.inertia * state.body_rates_frd));
  };
  const auto energy = [&] { return 0.5 * state.body_rates_frd.dot(vehicle.inertia * state.body_rates_frd); };
  const Vector3d momentum_at_start = momentum();
  const double energy_at_start = energy();
  const Vector3d rates_at_start = state.body_rates_frd;
  double rate_change = 0.0;
  for (int i = 0; i < 20000; ++i) {
    dynamics.advance(state, {}, kStillAir, 1.0e-3);
    rate_change = std::max(rate_change, (state.body_rates_frd - rates_at_start).norm());
    ASSERT_NEAR(energy(), energy_at_start, 1.0e-7 * energy_at_start);
    ASSERT_LT((momentum() - momentum_at_start).norm(), 1.0e-6 * momentum_at_start.norm());
  }
  EXPECT_GT(rate_change, 5.0) << "the body rates hardly change: the test shows nothing";
}

TEST(Dynamics, FallsFreelyWithRotorsOff) {
  const Dynamics dynamics(kaylion(), Supply::battery());
  VehicleState state;
  state.velocity_ned = {1.0, 2.0, -3.0};
  fly(dynamics, state, {}, 2.0, 2000);
  EXPECT_LT((state.position_ned - Vector3d(2.0, 4.0, -6.0 + 2.0 * 9.80665)).norm(), 1.0e-11);
  EXPECT_LT((state.velocity_ned - Vector3d(1.0, 2.0, -3.0 + 2.0 * 9.80665)).norm(), 1.0e-11);
  EXPECT_TRUE(dynamics.specific_force_frd(state, kStillAir).isZero(0.0));
}

struct HoverAnchor {
  double mass_kg;
  double supply_v;
  double throttle;
  double speed;
};

class Hover : public testing::TestWithParam<HoverAnchor> {};

TEST_P(Hover, IsInEquilibriumAtThePapersThrottle) {
  const HoverAnchor& anchor = GetParam();
  Vehicle vehicle = kaylion();
  vehicle.mass_kg = anchor.mass_kg;
  for (const plant::MotorModel model : {plant::MotorModel::kReduced, plant::MotorModel::kPhysical}) {
    vehicle.motor.model = model;
    const Dynamics dynamics(vehicle, Supply::constant(anchor.supply_v));
    VehicleState state = hovering(vehicle);
    fly(dynamics, state, running(anchor.throttle), 2.0, 2000);
    EXPECT_NEAR(state.rotor_speeds[0], anchor.speed, 1.5);
    // The anchors' throttles are rounded to 0.001, which is 0.3 % of lift.
    EXPECT_NEAR(state.velocity_ned.z(), 0.0, 2.0 * 0.003 * plant::kGravity);
    EXPECT_LT(state.velocity_ned.head<2>().norm(), 1.0e-12);
    EXPECT_LT(state.body_rates_frd.norm(), 1.0e-12);
    EXPECT_NEAR(dynamics.specific_force_frd(state, kStillAir).z(), -plant::kGravity, 0.003 * plant::kGravity);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Anchors, Hover,
    testing::Values(HoverAnchor{0.036, 3.6, 0.356, 1526.3}, HoverAnchor{0.036, 3.7, 0.337, 1526.3},
                    HoverAnchor{0.036, 4.2, 0.262, 1526.3}, HoverAnchor{0.040, 3.6, 0.417, 1608.8},
                    HoverAnchor{0.040, 3.7, 0.394, 1608.8}, HoverAnchor{0.040, 4.2, 0.306, 1608.8}));

TEST(Dynamics, RotorsIdleAtThrottleZeroAndStopWhenOff) {
  const Dynamics dynamics(kaylion(), Supply::constant(3.7));
  VehicleState state;
  fly(dynamics, state, running(0.0), 2.0, 2000);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(state.rotor_speeds[i], 666.0, 0.5);
  fly(dynamics, state, {}, 2.0, 2000);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(state.rotor_speeds[i], 0.0, 1.0e-4);
}

TEST(Dynamics, SimulatesEveryRotorOfTheVehicle) {
  for (int rotors = plant::kMinRotors; rotors <= plant::kMaxRotors; ++rotors) {
    const Vehicle vehicle = multirotor(rotors);
    const Dynamics dynamics(vehicle, Supply::constant(4.2));
    VehicleState state = hovering(vehicle);
    dynamics.advance(state, running(0.306), kStillAir, 1.0e-3);
    EXPECT_NEAR(dynamics.specific_force_frd(state, kStillAir).z(), -plant::kGravity, 0.001) << rotors;
    for (std::size_t i = 0; i < plant::kMaxRotors; ++i)
      EXPECT_EQ(state.rotor_speeds[i] > 0.0, i < static_cast<std::size_t>(rotors))
          << rotors << " rotors, " << i;
  }
}

// ---- inductance

TEST(Dynamics, CurrentIsStableAtAnyInductance) {
  for (const double inductance : {1.0e-5, 1.0e-4, 1.0e-3, 1.0e-2}) {
    Vehicle vehicle = kaylion();
    vehicle.motor.model = plant::MotorModel::kPhysical;
    vehicle.motor.armature_inductance_h = inductance;
    const Dynamics dynamics(vehicle, Supply::constant(4.0));
    VehicleState state;
    fly(dynamics, state, running(0.6), 3.0, 3000);
    const double v_a = std::sqrt(0.9205 * 16.0 * 0.6 + 0.6472);
    const double speed =
        (-1.020e-3 + std::sqrt(1.020e-3 * 1.020e-3 + 4.0 * 2.817e-7 * v_a)) / (2.0 * 2.817e-7);
    EXPECT_NEAR(state.rotor_speeds[0], speed, 1.0e-6 * speed) << inductance;
    const double current = dynamics.settled_currents(state, running(0.6))[0];
    EXPECT_NEAR(state.armature_currents[0], current, 1.0e-6 * current) << inductance;
  }
}

TEST(Dynamics, InductiveMotorConvergesToThePhysicalModel) {
  Vehicle vehicle = kaylion();
  vehicle.motor.model = plant::MotorModel::kPhysical;
  const auto speed_after = [&](double inductance) {
    vehicle.motor.armature_inductance_h = inductance;
    const Dynamics dynamics(vehicle, Supply::constant(4.0));
    VehicleState state;
    state.armature_currents = dynamics.settled_currents(state, running(0.6));
    fly(dynamics, state, running(0.6), 0.05, 50);
    return state.rotor_speeds[0];
  };
  const double limit = speed_after(0.0);
  const double coarse = std::abs(speed_after(4.0e-4) - limit);
  const double fine = std::abs(speed_after(2.0e-4) - limit);
  EXPECT_GT(coarse, 0.1);
  EXPECT_NEAR(coarse / fine, 2.0, 0.1);  // the difference is proportional to L_a
  EXPECT_LT(std::abs(speed_after(1.0e-6) - limit), 0.01 * coarse);
}

TEST(Dynamics, LimitsStepsByTheFastestTimeConstant) {
  Vehicle vehicle = kaylion();
  EXPECT_DOUBLE_EQ(Dynamics(vehicle, Supply::constant(4.0)).max_step_s(), 0.0821 / 3.0);
  EXPECT_DOUBLE_EQ(Dynamics(vehicle, Supply::battery()).max_step_s(), 0.02 / 3.0);
  vehicle.motor.model = plant::MotorModel::kPhysical;
  vehicle.motor.armature_inductance_h = 1.54e-4;
  EXPECT_DOUBLE_EQ(Dynamics(vehicle, Supply::battery()).max_step_s(), 1.0e-4 / 3.0);

  // One long advance() equals the short steps that it is divided into.
  const Dynamics dynamics(vehicle, Supply::battery());
  VehicleState at_once = tumbling();
  VehicleState in_steps = tumbling();
  dynamics.advance(at_once, running(0.5), kStillAir, 3.2e-4);
  fly(dynamics, in_steps, running(0.5), 3.2e-4, 10);
  EXPECT_LT(distance(at_once, in_steps), 1.0e-10);  // they normalise the quaternion at different times
}

// ---- battery

TEST(Dynamics, SagFollowsAFirstOrderLag) {
  Vehicle vehicle = kaylion();
  vehicle.battery.electronics_current_a = 2.0;
  const Dynamics dynamics(vehicle, Supply::battery());
  VehicleState state;  // rotors off and at rest: the electronics alone
  fly(dynamics, state, {}, 0.02, 20);
  EXPECT_NEAR(state.sag_v, 0.12 * 2.0 * (1.0 - std::exp(-1.0)), 1.0e-7);
  fly(dynamics, state, {}, 0.98, 980);
  EXPECT_NEAR(state.sag_v, 0.24, 1.0e-12);
  EXPECT_NEAR(dynamics.supply_current(state, {}), 2.0, 1.0e-12);
  // 2 A s of 864 A s; the last segment of the table rises by 0.12 V over a tenth of the charge.
  EXPECT_NEAR(state.state_of_charge, 1.0 - 2.0 / 864.0, 1.0e-12);
  EXPECT_NEAR(dynamics.supply_voltage(state), 4.19 - 1.2 * 2.0 / 864.0 - 0.24, 1.0e-12);
}

TEST(Dynamics, HoverDrawsItsPowerFromTheBattery) {
  // At hover i_a = (2.370 V - K1 1608.8 rad/s) / 1.54 ohm with K1 = 1.54 k_Q / K3: 0.4729 A, P = 4 * 1.121 W.
  const Vehicle& vehicle = kaylion();
  const Dynamics dynamics(vehicle, Supply::battery());
  VehicleState state = hovering(vehicle);
  state.state_of_charge = 0.9;
  const double k1 = 1.54 * 1.8623e-10 / 2.817e-7;
  const double hover = std::sqrt(0.04 * 9.80665 / 4.0 / 3.7901e-8);
  const double v_a = 1.020e-3 * hover + 2.817e-7 * hover * hover;
  const double power = 4.0 * v_a * (v_a - k1 * hover) / 1.54;
  // v_s (i - 0.08 A) = P and v_s = v_oc - 0.12 ohm i.
  const double v_oc = 4.07;
  const double a = v_oc + 0.12 * 0.08;
  const double current = (a - std::sqrt(a * a - 4.0 * 0.12 * (power + v_oc * 0.08))) / (2.0 * 0.12);
  const double v_s = v_oc - 0.12 * current;
  const double throttle = (v_a * v_a - 0.6472) / (0.9205 * v_s * v_s);

  fly(dynamics, state, running(throttle), 0.3, 300);
  EXPECT_NEAR(state.sag_v, 0.12 * current, 2.0e-4);
  EXPECT_NEAR(dynamics.supply_voltage(state), v_s, 2.0e-3);
  EXPECT_NEAR(dynamics.supply_current(state, running(throttle)), current, 2.0e-3);
  EXPECT_NEAR(0.9 - state.state_of_charge, current * 0.3 / 864.0, 0.01 * current * 0.3 / 864.0);
}

TEST(Dynamics, EmptyBatteryKeepsItsLowestVoltage) {
  Vehicle vehicle = kaylion();
  vehicle.battery.electronics_current_a = 1.0;
  const Dynamics dynamics(vehicle, Supply::battery());
  VehicleState state;
  state.state_of_charge = 1.0e-4;
  fly(dynamics, state, {}, 2.0, 2000);
  EXPECT_EQ(state.state_of_charge, 0.0);
  EXPECT_NEAR(dynamics.supply_voltage(state), 2.65 - 0.12, 1.0e-9);
}

TEST(Dynamics, IdealSupplyNeitherSagsNorEmpties) {
  const Dynamics dynamics(kaylion(), Supply::constant(3.7));
  VehicleState state;
  state.state_of_charge = 0.8;
  fly(dynamics, state, running(1.0), 5.0, 5000);
  EXPECT_EQ(state.state_of_charge, 0.8);
  EXPECT_EQ(dynamics.supply_voltage(state), 3.7);
  EXPECT_NEAR(state.rotor_speeds[0], 2214.0, 1.0);  // the anchor for full throttle at 3.7 V
}

TEST(Dynamics, BrakingRotorsDoNotChargeTheBattery) {
  const Dynamics dynamics(kaylion(), Supply::battery());
  VehicleState state = hovering(kaylion());
  state.state_of_charge = 0.5;
  const double before = dynamics.supply_current(state, running(0.0));
  EXPECT_NEAR(before, 0.08, 1.0e-12);
  dynamics.advance(state, running(0.0), kStillAir, 0.01);
  EXPECT_NEAR(0.5 - state.state_of_charge, 0.08 * 0.01 / 864.0, 1.0e-12);
}

// ---- air

TEST(Dynamics, FallReachesTheTerminalVelocity) {
  Vehicle vehicle = kaylion();
  vehicle.linear_drag = 0.1;
  const Dynamics dynamics(vehicle, Supply::battery());
  const Vector3d wind(2.0, -1.0, 0.5);
  VehicleState state;
  fly(dynamics, state, {}, 0.4, 400, wind);  // one time constant m / c
  const Vector3d terminal = wind + Vector3d(0.0, 0.0, 0.04 * 9.80665 / 0.1);
  EXPECT_LT((state.velocity_ned - terminal * (1.0 - std::exp(-1.0))).norm(), 1.0e-9);
  fly(dynamics, state, {}, 20.0, 20000, wind);
  EXPECT_LT((state.velocity_ned - terminal).norm(), 1.0e-9);
  // At the terminal velocity an accelerometer measures the same as at rest.
  state.q_ned_from_frd = Eigen::Quaterniond::Identity();
  EXPECT_LT((dynamics.specific_force_frd(state, wind) - Vector3d(0.0, 0.0, -plant::kGravity)).norm(), 1.0e-8);
}

// GIVEN a level vehicle in wind THEN each rad/s of its rotors drags it along the wind, and not along its thrust.
TEST(Dynamics, RotorDragActsInThePlaneOfTheRotors) {
  constexpr double kRotorDrag = 9.18e-7;  // Foerster 2015
  const Dynamics dynamics(kaylion(), Supply::constant(3.7), {kRotorDrag, 0.0, 0.0});
  const Dynamics without(kaylion(), Supply::constant(3.7));
  VehicleState state = hovering(kaylion());
  const double sum = 4.0 * state.rotor_speeds[0];
  const Vector3d wind(2.0, -1.0, 0.5);
  const Vector3d drag = dynamics.specific_force_frd(state, wind) - without.specific_force_frd(state, wind);
  EXPECT_LT((0.04 * drag - kRotorDrag * sum * Vector3d(2.0, -1.0, 0.0)).norm(), 1.0e-15);
  fly(dynamics, state, running(0.0), 1.0e-3, 1, wind);
  EXPECT_NEAR(state.velocity_ned.x(), 1.0e-3 * drag.x(), 1.0e-3 * 1.0e-3 * drag.x() * 20.0);
}

// Cheeseman and Bennett: a third more thrust at half a radius above the ground, a sixteenth more at one radius.
TEST(Dynamics, GroundEffectRaisesTheThrust) {
  constexpr double kRadius_m = 0.03;
  constexpr double kFloor_m = 0.02;
  const Dynamics dynamics(kaylion(), Supply::constant(3.7), {0.0, kRadius_m, kFloor_m});
  VehicleState state = hovering(kaylion());
  const double free = Dynamics(kaylion(), Supply::constant(3.7)).specific_force_frd(state, kStillAir).z();
  const auto factor_at = [&](double height_m) {
    state.position_ned.z() = kFloor_m - height_m;
    return dynamics.specific_force_frd(state, kStillAir).z() / free;
  };
  EXPECT_NEAR(factor_at(0.5 * kRadius_m), 4.0 / 3.0, 1.0e-12);
  EXPECT_NEAR(factor_at(kRadius_m), 16.0 / 15.0, 1.0e-12);
  EXPECT_NEAR(factor_at(1.0), 1.0, 1.0e-4);
  EXPECT_EQ(factor_at(0.1 * kRadius_m), factor_at(0.5 * kRadius_m)) << "no nearer";
}

}  // namespace swiftlet::tests::dynamics_test
