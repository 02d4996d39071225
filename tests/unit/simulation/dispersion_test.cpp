#include "swiftlet/simulation/dispersion.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "swiftlet/plant/simulation/streams.hpp"
#include "swiftlet/simulation/dispersion_file.hpp"
#include "tests/unit/io/config_error_check.hpp"
#include "tests/unit/simulation/nominal_world.hpp"

namespace swiftlet::simulation::dispersion_test {

Dispersion parse(const std::string& parameters) {
  return parse_dispersion_file("parameters:\n" + parameters, "v.yaml", nominal());
}

const std::string kMass =
    "  vehicle.mass: {distribution: normal, mean: 1, sigma: 0.02, min: 0.95, max: 1.05, unit: nominal, "
    "source: estimate}\n";
const std::string kLatency =
    "  simulation.mocap.latency_s: {distribution: uniform, min: 0.005, max: 0.02, unit: s, source: "
    "estimate}\n";
const std::string kInertia =
    "  vehicle.inertia: {distribution: uniform, min: 0.8, max: 1.2, unit: nominal, source: estimate}\n";
const std::string kRoll =
    "  vehicle.inertia.xx: {distribution: uniform, min: 0.7, max: 1.3, unit: nominal, source: estimate}\n";
const std::string kK2 =
    "  vehicle.motor.k2: {distribution: uniform, min: 0.9, max: 1.1, unit: nominal, source: estimate}\n";

TEST(DispersionSample, DependsOnTheSeedAndNotOnEarlierDraws) {
  const Dispersion dispersion = parse(kMass + kLatency);
  const std::vector<double> first = draw(dispersion, nominal(), 5).values;
  draw(dispersion, nominal(), 6);
  EXPECT_EQ(draw(dispersion, nominal(), 5).values, first);
  EXPECT_NE(draw(dispersion, nominal(), 6).values, first);
}

TEST(DispersionSample, IsIndependentOfKeyOrderAndOtherKeys) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const std::vector<double> both = draw(parse(kMass + kLatency), nominal(), seed).values;
    EXPECT_EQ(draw(parse(kLatency + kMass), nominal(), seed).values, both);
    EXPECT_EQ(draw(parse(kMass), nominal(), seed).values[0], both[0]);
    EXPECT_EQ(draw(parse(kLatency), nominal(), seed).values[0], both[1]);
  }
}

TEST(DispersionSample, UsesOneStreamPerParameterApartFromTheSimulation) {
  std::set<std::uint64_t> ids;
  for (const Parameter& parameter : parameters()) {
    const std::uint64_t id = plant::streams::of_name(parameter.name);
    EXPECT_TRUE(ids.insert(id).second) << parameter.name;
    EXPECT_GT(id, 1000U) << parameter.name;
  }
}

TEST(DispersionSample, FollowsTheDistributionOverSeeds) {
  constexpr int kDraws = 2000;
  const Dispersion dispersion = parse(kMass + kLatency);
  double mass_sum = 0.0;
  double latency_sum = 0.0;
  double product_sum = 0.0;
  for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
    const DispersionSample one = draw(dispersion, nominal(), seed);
    const double mass = one.values[0] / nominal().vehicle.mass_kg;
    ASSERT_GE(mass, 0.95);
    ASSERT_LE(mass, 1.05);
    ASSERT_GE(one.values[1], 0.005);
    ASSERT_LE(one.values[1], 0.02);
    EXPECT_EQ(one.world.vehicle.mass_kg, one.values[0]);
    EXPECT_EQ(one.world.simulation.mocap.latency_s, one.values[1]);
    mass_sum += mass;
    latency_sum += one.values[1];
    product_sum += (mass - 1.0) / 0.02 * (one.values[1] - 0.0125) / (0.015 / std::sqrt(12.0));
  }
  const double bound = 5.0 / std::sqrt(kDraws);
  EXPECT_NEAR(mass_sum / kDraws, 1.0, bound * 0.02);
  EXPECT_NEAR(latency_sum / kDraws, 0.0125, bound * 0.015 / std::sqrt(12.0));
  EXPECT_NEAR(product_sum / kDraws, 0.0, bound) << "mass and latency are correlated";
}

TEST(DispersionSample, KeepsOtherParametersNominal) {
  World drawn = draw(parse(kMass), nominal(), 3).world;
  drawn.vehicle.mass_kg = nominal().vehicle.mass_kg;
  World before = nominal();
  for (const Parameter& parameter : parameters()) {
    const std::vector<double*> now = parameter.in(drawn);
    const std::vector<double*> then = parameter.in(before);
    for (std::size_t i = 0; i < now.size(); ++i) EXPECT_EQ(*now[i], *then[i]) << parameter.name;
  }
}

TEST(DispersionSample, ScalesTheWholeInertiaBeforeItsElements) {
  const DispersionSample one = draw(parse(kInertia + kRoll), nominal(), 9);
  const double factor = one.values[0];
  const Eigen::Matrix3d& drawn = one.world.vehicle.inertia;
  const Eigen::Matrix3d& before = nominal().vehicle.inertia;
  EXPECT_DOUBLE_EQ(drawn(1, 1), factor * before(1, 1));
  EXPECT_DOUBLE_EQ(drawn(2, 2), factor * before(2, 2));
  EXPECT_EQ(drawn(0, 0), one.values[1]);
  EXPECT_NE(drawn(0, 0), factor * before(0, 0));
}

TEST(DispersionSample, IsRedrawnIfTheInertiaIsInvalid) {
  const Dispersion dispersion = parse(kRoll);
  int rejected = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const DispersionSample one = draw(dispersion, nominal(), seed);
    rejected += one.rejected;
    EXPECT_TRUE(validate(one.world).empty());
  }
  EXPECT_GT(rejected, 50) << "an inertia xx much below the nominal breaks the triangle inequality";
}

TEST(DispersionSample, IsRefusedAfterOneHundredInvalidDraws) {
  const Dispersion dispersion =
      parse("  vehicle.inertia.zz: {distribution: uniform, min: 1.5, max: 2, unit: nominal, source: x}\n");
  const std::string sentence = tests::refusal([&] { draw(dispersion, nominal(), 17); });
  EXPECT_EQ(
      sentence.find("v.yaml: parameters: seed 17: 100 samples in a row break a rule, the last: inertia "), 0U)
      << sentence;
}

TEST(DispersionSample, ScalesTheResistanceWithTheMotorConstants) {
  const plant::Vehicle& before = nominal().vehicle;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const DispersionSample one = draw(parse(kK2), nominal(), seed);
    EXPECT_EQ(one.rejected, 0);
    EXPECT_DOUBLE_EQ(one.world.vehicle.motor.armature_resistance_ohm,
                     before.motor.armature_resistance_ohm * one.values[0] / before.motor.k2);
  }
}

}  // namespace swiftlet::simulation::dispersion_test
