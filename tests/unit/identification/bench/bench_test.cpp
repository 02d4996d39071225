#include "swiftlet/identification/bench/bench.hpp"

#include <algorithm>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/identification/bench/benches.hpp"

namespace swiftlet::identification::bench_test {

using tests::bench_of;
using tests::contains;
using tests::kaylion;

// Differs from the base in every parameter that a bench measures.
plant::Vehicle other() {
  plant::Vehicle v = kaylion();
  v.mass_kg = 0.045;
  v.inertia = Eigen::Vector3d(5e-5, 5.5e-5, 9.5e-5).asDiagonal();
  v.esc.gain = 0.88;
  v.esc.offset_v2 = 0.4;
  v.motor.k2 = 1.1e-3;
  v.motor.k3 = 2.5e-7;
  v.motor.time_constant_s = 0.06;
  v.motor.armature_resistance_ohm = 1.3;
  v.rotor.thrust = 4.2e-8;
  v.rotor.torque = 2.0e-10;
  return v;
}

TEST(Bench, IdentifiesTheWholeVehicleWithoutNoise) {
  const plant::Vehicle truth = other();
  ASSERT_TRUE(plant::validate(truth).empty());
  const BenchIdentification found = identify_bench(bench_of(truth, 0.0), kaylion());
  const plant::Vehicle& v = found.vehicle;
  EXPECT_NEAR(v.mass_kg / truth.mass_kg, 1.0, 1e-9);
  EXPECT_NEAR(v.esc.gain / truth.esc.gain, 1.0, 1e-6);
  EXPECT_NEAR(v.esc.offset_v2 / truth.esc.offset_v2, 1.0, 1e-6);
  EXPECT_NEAR(v.motor.k2 / truth.motor.k2, 1.0, 1e-6);
  EXPECT_NEAR(v.motor.k3 / truth.motor.k3, 1.0, 1e-6);
  EXPECT_NEAR(v.motor.time_constant_s / truth.motor.time_constant_s, 1.0, 1e-4);
  EXPECT_NEAR(v.rotor.thrust / truth.rotor.thrust, 1.0, 1e-9);
  EXPECT_NEAR(v.rotor.torque / truth.rotor.torque, 1.0, 1e-9);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(v.inertia(i, i) / truth.inertia(i, i), 1.0, 1e-8);
  EXPECT_TRUE(plant::validate(v).empty());
  EXPECT_EQ(found.uncertainty.parameters.size(), 11U);
  for (const plant::ParameterUncertainty& p : found.uncertainty.parameters)
    EXPECT_EQ(found.sources.count(p.parameter), 1U);
}

TEST(Bench, KeepsTheBaseWhereNothingWasMeasured) {
  BenchData data;
  data.esc = bench_of(other(), 0.002).esc;
  const BenchIdentification found = identify_bench(data, kaylion());
  EXPECT_NEAR(found.vehicle.esc.gain, 0.88, 0.01);
  EXPECT_EQ(found.vehicle.motor.k2, kaylion().motor.k2);
  EXPECT_EQ(found.uncertainty.parameters.size(), 2U);
  ASSERT_EQ(found.uncertainty.correlations.size(), 1U);
  EXPECT_LT(found.uncertainty.correlations[0].value, -0.3);
}

TEST(Bench, ReportsTheCorrelationOfK2AndK3) {
  const BenchIdentification found = identify_bench(bench_of(other(), 0.005), kaylion());
  const auto& all = found.uncertainty.correlations;
  const auto it = std::find_if(all.begin(), all.end(), [](const auto& c) { return c.first == "motor.k2"; });
  ASSERT_NE(it, all.end());
  EXPECT_EQ(it->second, "motor.k3");
  EXPECT_LT(it->value, -0.9);
}

TEST(Bench, ReportsTheCorrelationOfInertiaAndMass) {
  BenchData data = bench_of(kaylion(), 0.001);
  data.mass_kg->front() *= 1.02;  // 1 % spread
  const BenchIdentification found = identify_bench(data, kaylion());
  std::map<std::string, double> correlations;
  for (const plant::ParameterCorrelation& c : found.uncertainty.correlations)
    correlations[c.first + " " + c.second] = c.value;
  const auto relative = [](const std::optional<Experiment>& of) {
    return of->estimates.front().standard_error / of->estimates.front().value;
  };
  const char* const inertias[3] = {"mass inertia.xx", "mass inertia.yy", "mass inertia.zz"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_GT(correlations[inertias[axis]], 0.2) << axis;
    EXPECT_NEAR(correlations[inertias[axis]], relative(found.mass) / relative(found.inertia[axis]), 1e-9);
  }
  EXPECT_NEAR(correlations["inertia.xx inertia.yy"],
              correlations["mass inertia.xx"] * correlations["mass inertia.yy"], 1e-9);
}

TEST(Bench, AdaptsAResistanceThatWasNotMeasured) {
  plant::Vehicle base = kaylion();
  base.motor.armature_resistance_ohm = 1.5;
  const BenchIdentification found = identify_bench(bench_of(other(), 0.0), base);
  EXPECT_TRUE(contains(found.warnings, "armature resistance"));
  EXPECT_NEAR(found.vehicle.motor.armature_resistance_ohm, 1.1e-3 * 2.5e-7 / 2.0e-10, 1e-6);
  EXPECT_TRUE(plant::validate(found.vehicle).empty());
}

// KayLion's moments are 1 % below the limit: noise of the periods alone exceeds it.
TEST(Bench, ProjectsNoisyInertiaOntoTheTriangleInequality) {
  int beyond = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    BenchData data;
    data.inertia = bench_of(kaylion(), 0.01, seed).inertia;
    const BenchIdentification found = identify_bench(data, kaylion());
    EXPECT_TRUE(plant::validate(found.vehicle).empty()) << seed;
    if (!contains(found.warnings, "the limit for any body")) continue;
    ++beyond;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const ParameterEstimate& estimate = found.inertia[i]->estimates.front();
      EXPECT_NEAR(found.vehicle.inertia(axis, axis), estimate.value, 2.0 * estimate.half_width);
    }
  }
  EXPECT_GT(beyond, 0);
}

TEST(Bench, KeepsAnInertiaFarBeyondTheLimitForValidation) {
  BenchData data;
  data.inertia = bench_of(kaylion(), 0.002).inertia;
  data.inertia[2]->bifilar->period_s = tests::times(data.inertia[2]->bifilar->period_s, 1.2);
  EXPECT_FALSE(plant::validate(identify_bench(data, kaylion()).vehicle).empty());
}

TEST(Bench, AdaptsMomentsThatWereNotMeasured) {
  BenchData data;
  data.inertia[2] = bench_of(kaylion(), 0.0).inertia[2];
  data.inertia[2]->bifilar->period_s = tests::times(data.inertia[2]->bifilar->period_s, 1.2);
  const BenchIdentification found = identify_bench(data, kaylion());
  EXPECT_TRUE(plant::validate(found.vehicle).empty());
  EXPECT_NEAR(found.vehicle.inertia(2, 2), 1.44 * 8.8e-5, 1e-10);
}

TEST(Bench, WarnsWhenThrustOverThrottleContradictsTheRest) {
  BenchData data = bench_of(other(), 0.005);
  EXPECT_TRUE(contains(identify_bench(data, kaylion()).throttle_thrust->findings, "closes"));
  data.throttle_thrust->thrust_n = tests::times(data.throttle_thrust->thrust_n, 1.2);
  EXPECT_TRUE(contains(identify_bench(data, kaylion()).throttle_thrust->warnings, "should be within 5 %"));
}

TEST(Bench, RefusesSpeedsInAWrongUnit) {
  BenchData data;
  data.thrust_torque = bench_of(kaylion(), 0.005).thrust_torque;
  EXPECT_NO_THROW(identify_bench(data, kaylion()));
  data.thrust_torque->speed_rad_s = tests::times(data.thrust_torque->speed_rad_s, 0.10472);
  EXPECT_TRUE(contains({tests::refused<BenchError>([&] { identify_bench(data, kaylion()); })},
                       "the largest propeller that fits"));
}

TEST(Bench, ChecksTorqueAloneAgainstTheThrustOfTheBase) {
  for (const double unit : {1e-3, 1e3}) {
    BenchData data;
    data.thrust_torque = bench_of(kaylion(), 0.005).thrust_torque;
    data.thrust_torque->thrust_n.clear();
    EXPECT_NO_THROW(identify_bench(data, kaylion()));
    data.thrust_torque->torque_n_m = tests::times(data.thrust_torque->torque_n_m, unit);
    EXPECT_TRUE(contains({tests::refused<BenchError>([&] { identify_bench(data, kaylion()); })},
                         "torque: torque over thrust is"));
  }
}

TEST(Bench, NamesTheInvalidExperiment) {
  BenchData data = bench_of(other(), 0.005);
  data.steady_motor->speed_rad_s.resize(3);
  data.steady_motor->motor_voltage_v.resize(3);
  try {
    identify_bench(data, kaylion());
    FAIL() << "expected BenchError";
  } catch (const BenchError& fault) {
    EXPECT_EQ(fault.experiment(), kSteadyMotorName);
  }
}

TEST(Bench, IsDeterministic) {
  const BenchData data = bench_of(other(), 0.01, 5, 0.05);
  const BenchIdentification first = identify_bench(data, kaylion());
  const BenchIdentification second = identify_bench(bench_of(other(), 0.01, 5, 0.05), kaylion());
  EXPECT_EQ(first.vehicle.motor.k2, second.vehicle.motor.k2);
  EXPECT_EQ(first.vehicle.motor.time_constant_s, second.vehicle.motor.time_constant_s);
  EXPECT_EQ(first.esc->outliers, second.esc->outliers);
}

}  // namespace swiftlet::identification::bench_test
