// Bias and interval coverage of bench identification over many seeds.
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/campaign.hpp"
#include "tests/unit/identification/bench/benches.hpp"

namespace swiftlet::identification::recovery_test {

struct Tally {
  int count = 0;
  int covered = 0;
  double error = 0.0;  // sum of relative errors

  double coverage() const { return static_cast<double>(covered) / count; }
  double bias() const { return error / count; }
};

std::map<std::string, double> truth_of(const plant::Vehicle& v) {
  return {{"mass", v.mass_kg},
          {"esc.gain", v.esc.gain},
          {"esc.offset", v.esc.offset_v2},
          {"motor.k2", v.motor.k2},
          {"motor.k3", v.motor.k3},
          {"motor.time_constant", v.motor.time_constant_s},
          {"rotor.thrust_factor", v.rotor.thrust},
          {"rotor.torque_factor", v.rotor.torque},
          {"inertia.xx", v.inertia(0, 0)},
          {"inertia.yy", v.inertia(1, 1)},
          {"inertia.zz", v.inertia(2, 2)}};
}

enum class Records { kAll, kStatic };

std::map<std::string, Tally> recover(const plant::Vehicle& truth, double share, double outliers, int seeds,
                                     Records records) {
  // The base differs from the truth, so that an unchanged value is not taken for an identified one.
  plant::Vehicle base = truth;
  base.esc = {1.0, 0.3, truth.esc.pulse_min_us, truth.esc.pulse_range_us};
  base.mass_kg *= 1.3;
  base.rotor.thrust *= 0.8;
  const std::map<std::string, double> expected = truth_of(truth);
  std::map<std::string, Tally> tallies;
  for (int seed = 1; seed <= seeds; ++seed) {
    BenchData data = tests::bench_of(truth, share, static_cast<std::uint64_t>(seed), outliers);
    if (records == Records::kStatic) data.motor_step.reset();
    for (const plant::ParameterUncertainty& p : identify_bench(data, base).uncertainty.parameters) {
      const double value = expected.at(p.parameter);
      Tally& tally = tallies[p.parameter];
      ++tally.count;
      tally.covered += p.low <= value && value <= p.high ? 1 : 0;
      tally.error += 0.5 * (p.low + p.high) / value - 1.0;
    }
  }
  return tallies;
}

constexpr double kBias = 0.07;  // of one bench; bounds the mean of 200 benches to 0.5 %

double pooled_coverage(const std::map<std::string, Tally>& tallies) {
  double covered = 0.0;
  double count = 0.0;
  for (const auto& [name, tally] : tallies) {
    covered += tally.covered;
    count += tally.count;
  }
  return covered / count;
}

// With 200 benches the standard error of one parameter's coverage is 1.5 %. Each parameter may deviate by
// three of these, the pooled coverage by 1.3: the parameters are correlated and count as 5 independent ones,
// not 11.
void expect_recovery(double share, double outliers) {
  const int benches = tests::draws(40, 200);
  const std::map<std::string, Tally> tallies =
      recover(tests::kaylion(), share, outliers, benches, Records::kAll);
  ASSERT_EQ(tallies.size(), 11U);
  for (const auto& [name, tally] : tallies) {
    EXPECT_EQ(tally.count, benches) << name;
    EXPECT_LT(std::abs(tally.bias()), tests::bound_of_mean(kBias, benches)) << name;
    EXPECT_NEAR(tally.coverage(), 0.95, 3.0 * tests::coverage_error(benches)) << name;
  }
  EXPECT_NEAR(pooled_coverage(tallies), 0.95, 1.3 * tests::coverage_error(benches));
}

TEST(Recovery, IsUnbiasedAndCoversTheTruth) { expect_recovery(0.005, 0.0); }

TEST(Recovery, IsUnbiasedAndCoversTheTruthWithOutliers) { expect_recovery(0.005, 0.04); }

// In a soak, 1500 benches give each parameter's coverage a standard error of 0.6 %.
TEST(Recovery, CoversTheTruthOfEachParameter) {
  const int benches = tests::draws(100, 1500);
  for (const auto& [name, tally] : recover(tests::kaylion(), 0.005, 0.0, benches, Records::kStatic)) {
    EXPECT_LT(std::abs(tally.bias()), tests::bound_of_mean(kBias, benches)) << name;
    EXPECT_NEAR(tally.coverage(), 0.95, 3.5 * tests::coverage_error(benches)) << name;
  }
}

// The step response of the physical model differs in shape from the reduced model's.
TEST(Recovery, CoversTheTimeConstantOfAPhysicalMotor) {
  plant::Vehicle truth = tests::kaylion();
  truth.motor.model = plant::MotorModel::kPhysical;
  Tally tally;
  const int benches = tests::draws(50, 200);
  for (int seed = 1; seed <= benches; ++seed) {
    BenchData data;
    data.motor_step = tests::bench_of(truth, 0.005, static_cast<std::uint64_t>(seed)).motor_step;
    const BenchIdentification found = identify_bench(data, truth);
    EXPECT_EQ(found.vehicle.motor.model, plant::MotorModel::kPhysical);
    const plant::ParameterUncertainty& p = found.uncertainty.parameters.front();
    ++tally.count;
    tally.covered += p.low <= 0.0821 && 0.0821 <= p.high ? 1 : 0;
    tally.error += 0.5 * (p.low + p.high) / 0.0821 - 1.0;
  }
  EXPECT_LT(std::abs(tally.bias()), tests::bound_of_mean(kBias, benches));
  EXPECT_NEAR(tally.coverage(), 0.95, 3.0 * tests::coverage_error(benches));
}

}  // namespace swiftlet::identification::recovery_test
