// Bench data computed from the paper's equations alone, independent of simulate_bench(): identification
// recovers their parameters, and simulate_bench() gives the same data.
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/identification/bench/benches.hpp"

namespace swiftlet::identification::bench_by_formulas_test {

using tests::kaylion;

constexpr double kWeightPerMass = 9.80665;  // m/s^2

// Differs from KayLion in every parameter that a bench measures.
struct Truth {
  double mass_kg = 0.045;
  double esc_gain = 0.88, esc_offset = 0.4;
  double k2 = 1.1e-3, k3 = 2.5e-7;
  double tau_s = 0.06;
  double thrust = 4.2e-8, torque = 2.0e-10;
  double inertia[3] = {5e-5, 5.5e-5, 9.5e-5};
  double separation_m = 2.0 * 0.0695;

  double voltage(double supply_v, double throttle) const {  // Eq. (9)
    return std::sqrt(esc_gain * supply_v * supply_v * throttle + esc_offset);
  }
  double speed(double v_a) const {  // Eq. (22), its positive root
    return (-k2 + std::sqrt(k2 * k2 + 4.0 * k3 * v_a)) / (2.0 * k3);
  }
  double hover_speed() const { return std::sqrt(mass_kg * kWeightPerMass / 4.0 / thrust); }
  double hover_voltage() const { return k2 * hover_speed() + k3 * hover_speed() * hover_speed(); }

  plant::Vehicle vehicle() const {
    plant::Vehicle v = kaylion();
    v.mass_kg = mass_kg;
    v.inertia = Eigen::Vector3d(inertia[0], inertia[1], inertia[2]).asDiagonal();
    v.esc.gain = esc_gain;
    v.esc.offset_v2 = esc_offset;
    v.motor.k2 = k2;
    v.motor.k3 = k3;
    v.motor.time_constant_s = tau_s;
    v.motor.armature_resistance_ohm = 1.3;
    v.rotor.thrust = thrust;
    v.rotor.torque = torque;
    return v;
  }
};

// Omega(t) of tau dOmega/dt = Omega_ss - Omega from rest.
double reduced_rise(const Truth& truth, double t) {
  return truth.hover_speed() * (1.0 - std::exp(-t / truth.tau_s));
}
// Omega(t) of J dOmega/dt = c (v - K2 Omega - K3 Omega^2) from rest, which reaches 1 - 1/e of its final value
// at tau. With the roots W1 > 0 > W2 of the right side, (Omega - W1) / (Omega - W2) = W1 / W2 e^(-k t).
double physical_rise(const Truth& truth, double t) {
  const double w1 = truth.hover_speed();
  const double ratio = w1 / (-truth.k2 / truth.k3 - w1);
  const double share = 1.0 - std::exp(-1.0);
  const double k = -std::log((1.0 - share) / (1.0 - share * ratio)) / truth.tau_s;
  return w1 * (1.0 - std::exp(-k * t)) / (1.0 - ratio * std::exp(-k * t));
}

// noise: standard deviation of a reading over its column's largest value.
BenchData bench_by_formulas(const Truth& truth, double noise, unsigned seed,
                            const std::function<double(const Truth&, double)>& rise = reduced_rise) {
  std::seed_seq seeds{seed, 9u};
  std::mt19937_64 generator(seeds);
  std::normal_distribution<double> normal;
  const auto read = [&](std::vector<double>& column) {
    const double full = *std::max_element(column.begin(), column.end());
    for (double& value : column) value += noise * full * normal(generator);
  };
  BenchData data;
  data.mass_kg = std::vector<double>(8, truth.mass_kg);
  read(*data.mass_kg);
  data.esc.emplace();
  data.throttle_thrust.emplace();
  for (const double supply_v : {4.190, 4.040, 3.906, 3.809, 3.637}) {
    for (int i = 1; i <= 9; ++i) {
      const double v_a = truth.voltage(supply_v, 0.1 * i);
      data.esc->supply_voltage_v.push_back(supply_v);
      data.esc->throttle.push_back(0.1 * i);
      data.esc->motor_voltage_v.push_back(v_a);
      data.throttle_thrust->supply_voltage_v.push_back(supply_v);
      data.throttle_thrust->throttle.push_back(0.1 * i);
      data.throttle_thrust->thrust_n.push_back(truth.thrust * truth.speed(v_a) * truth.speed(v_a));
    }
  }
  read(data.esc->supply_voltage_v);
  read(data.esc->motor_voltage_v);
  read(data.throttle_thrust->supply_voltage_v);
  read(data.throttle_thrust->thrust_n);
  data.steady_motor.emplace();
  data.thrust_torque.emplace();
  const double full_v = truth.voltage(kaylion().battery.open_circuit_voltage_v.back(), 1.0);
  for (int i = 0; i < 40; ++i) {
    const double v_a = full_v * (0.1 + 0.9 * i / 39.0);
    data.steady_motor->motor_voltage_v.push_back(v_a);
    data.steady_motor->speed_rad_s.push_back(truth.speed(v_a));
    const double speed = truth.speed(full_v) * (0.25 + 0.75 * i / 39.0);
    data.thrust_torque->speed_rad_s.push_back(speed);
    data.thrust_torque->thrust_n.push_back(truth.thrust * speed * speed);
    data.thrust_torque->torque_n_m.push_back(truth.torque * speed * speed);
  }
  read(data.steady_motor->motor_voltage_v);
  read(data.steady_motor->speed_rad_s);
  read(data.thrust_torque->speed_rad_s);
  read(data.thrust_torque->thrust_n);
  read(data.thrust_torque->torque_n_m);
  data.motor_step.emplace();
  for (int i = 0; i < 460; ++i) {
    const double t = 1e-3 * (i - 100);
    data.motor_step->time_s.push_back(1e-3 * i);
    data.motor_step->motor_voltage_v.push_back(t < 0.0 ? 0.0 : truth.hover_voltage());
    data.motor_step->speed_rad_s.push_back(t < 0.0 ? 0.0 : rise(truth, t));
  }
  read(data.motor_step->motor_voltage_v);
  read(data.motor_step->speed_rad_s);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    BifilarData bifilar;
    for (const double length_m : {0.6, 0.9, 1.2}) {
      for (int i = 0; i < 4; ++i) {
        bifilar.length_m.push_back(length_m);
        bifilar.separation_m.push_back(truth.separation_m);
        bifilar.period_s.push_back(
            4.0 * M_PI / truth.separation_m *
            std::sqrt(truth.inertia[axis] * length_m / (truth.mass_kg * kWeightPerMass)) *
            (1.0 + noise * normal(generator)));
      }
    }
    data.inertia[axis] = InertiaData{bifilar, {}};
  }
  return data;
}

std::map<std::string, double> values_of(const Truth& t) {
  return {{"mass", t.mass_kg},
          {"esc.gain", t.esc_gain},
          {"esc.offset", t.esc_offset},
          {"motor.k2", t.k2},
          {"motor.k3", t.k3},
          {"motor.time_constant", t.tau_s},
          {"rotor.thrust_factor", t.thrust},
          {"rotor.torque_factor", t.torque},
          {"inertia.xx", t.inertia[0]},
          {"inertia.yy", t.inertia[1]},
          {"inertia.zz", t.inertia[2]}};
}

TEST(BenchByFormulas, IdentifiesTheTrueParametersWithoutNoise) {
  const Truth truth;
  const plant::Vehicle v = identify_bench(bench_by_formulas(truth, 0.0, 1), kaylion()).vehicle;
  EXPECT_NEAR(v.mass_kg / truth.mass_kg, 1.0, 1e-9);
  EXPECT_NEAR(v.esc.gain / truth.esc_gain, 1.0, 1e-6);
  EXPECT_NEAR(v.esc.offset_v2 / truth.esc_offset, 1.0, 1e-6);
  EXPECT_NEAR(v.motor.k2 / truth.k2, 1.0, 1e-6);
  EXPECT_NEAR(v.motor.k3 / truth.k3, 1.0, 1e-6);
  EXPECT_NEAR(v.motor.time_constant_s / truth.tau_s, 1.0, 1e-4);
  EXPECT_NEAR(v.rotor.thrust / truth.thrust, 1.0, 1e-9);
  EXPECT_NEAR(v.rotor.torque / truth.torque, 1.0, 1e-9);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(v.inertia(i, i) / truth.inertia[i], 1.0, 1e-8) << i;
}

TEST(BenchByFormulas, IdentifiesTheTimeConstantOfAPhysicalMotor) {
  const Truth truth;
  plant::Vehicle base = truth.vehicle();
  base.motor.model = plant::MotorModel::kPhysical;
  base.motor.time_constant_s = 0.09;
  BenchData data;
  data.motor_step = bench_by_formulas(truth, 0.0, 1, physical_rise).motor_step;
  const BenchIdentification found = identify_bench(data, base);
  EXPECT_TRUE(found.motor_step->physical_fits_better);
  EXPECT_NEAR(found.vehicle.motor.time_constant_s / truth.tau_s, 1.0, 1e-4);
  EXPECT_NEAR(found.motor_step->reading.value / truth.tau_s, 1.0, 0.01) << "63.2 % of the rise";
}

TEST(BenchByFormulas, IntervalsCoverTheTruthAt95Percent) {
  const Truth truth;
  const std::map<std::string, double> expected = values_of(truth);
  constexpr int kBenches = 60;
  int held = 0;
  int count = 0;
  std::map<std::string, double> errors;
  for (unsigned seed = 1; seed <= kBenches; ++seed) {
    const auto found =
        identify_bench(bench_by_formulas(truth, 0.005, seed), kaylion()).uncertainty.parameters;
    ASSERT_EQ(found.size(), expected.size());
    for (const plant::ParameterUncertainty& p : found) {
      const double value = expected.at(p.parameter);
      held += p.low <= value && value <= p.high ? 1 : 0;
      ++count;
      errors[p.parameter] += (0.5 * (p.low + p.high) - value) / (0.5 * (p.high - p.low)) / kBenches;
    }
  }
  // The parameters of a bench are correlated: they count as 5 independent ones, not 11.
  EXPECT_NEAR(static_cast<double>(held) / count, 0.95, 3.0 * std::sqrt(0.95 * 0.05 / (5.0 * kBenches)));
  // Mean error in half widths. One error has a standard deviation of slightly more than 1 / 1.96 half widths.
  for (const auto& [name, mean] : errors) EXPECT_LT(std::abs(mean), 3.5 * 0.55 / std::sqrt(kBenches)) << name;
}

void expect_same(const std::vector<double>& simulated, const std::vector<double>& by_formulas,
                 double accuracy) {
  ASSERT_EQ(simulated.size(), by_formulas.size());
  const double full = *std::max_element(by_formulas.begin(), by_formulas.end());
  for (std::size_t i = 0; i < simulated.size(); ++i)
    EXPECT_NEAR(simulated[i], by_formulas[i], accuracy * full) << "row " << i;
}

// The other tests use simulated benches: this one ties them to the equations.
TEST(BenchByFormulas, EqualsTheSimulatedBench) {
  const Truth truth;
  const BenchData formulas = bench_by_formulas(truth, 0.0, 1);
  const BenchData simulated = tests::bench_of(truth.vehicle(), 0.0);
  expect_same(*simulated.mass_kg, *formulas.mass_kg, 1e-12);
  // The supplies are fractions of a full battery's voltage, rounded here.
  expect_same(simulated.esc->supply_voltage_v, formulas.esc->supply_voltage_v, 3e-3);
  for (std::size_t i = 0; i < simulated.esc->throttle.size(); ++i) {
    const double v_a = truth.voltage(simulated.esc->supply_voltage_v[i], simulated.esc->throttle[i]);
    EXPECT_NEAR(simulated.esc->motor_voltage_v[i], v_a, 1e-12);
    const double speed = truth.speed(v_a);
    EXPECT_NEAR(simulated.throttle_thrust->thrust_n[i], truth.thrust * speed * speed, 1e-12);
  }
  expect_same(simulated.esc->throttle, formulas.esc->throttle, 1e-12);
  expect_same(simulated.steady_motor->motor_voltage_v, formulas.steady_motor->motor_voltage_v, 1e-12);
  expect_same(simulated.steady_motor->speed_rad_s, formulas.steady_motor->speed_rad_s, 1e-12);
  expect_same(simulated.thrust_torque->speed_rad_s, formulas.thrust_torque->speed_rad_s, 1e-12);
  expect_same(simulated.thrust_torque->thrust_n, formulas.thrust_torque->thrust_n, 1e-12);
  expect_same(simulated.thrust_torque->torque_n_m, formulas.thrust_torque->torque_n_m, 1e-12);
  expect_same(simulated.motor_step->time_s, formulas.motor_step->time_s, 1e-12);
  expect_same(simulated.motor_step->motor_voltage_v, formulas.motor_step->motor_voltage_v, 1e-12);
  expect_same(simulated.motor_step->speed_rad_s, formulas.motor_step->speed_rad_s, 1e-9);
  plant::Vehicle physical = truth.vehicle();
  physical.motor.model = plant::MotorModel::kPhysical;
  expect_same(tests::bench_of(physical, 0.0).motor_step->speed_rad_s,
              bench_by_formulas(truth, 0.0, 1, physical_rise).motor_step->speed_rad_s, 1e-6);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    expect_same(simulated.inertia[axis]->bifilar->length_m, formulas.inertia[axis]->bifilar->length_m, 1e-12);
    expect_same(simulated.inertia[axis]->bifilar->period_s, formulas.inertia[axis]->bifilar->period_s, 1e-9);
  }
}

}  // namespace swiftlet::identification::bench_by_formulas_test
