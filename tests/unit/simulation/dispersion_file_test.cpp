#include "swiftlet/simulation/dispersion_file.hpp"

#include <string>

#include <gtest/gtest.h>

#include "tests/support/paths.hpp"
#include "tests/unit/fault.hpp"
#include "tests/unit/io/config_error_check.hpp"
#include "tests/unit/simulation/nominal_world.hpp"

namespace swiftlet::simulation::dispersion_file_test {

Dispersion parse(const std::string& text) { return parse_dispersion_file(text, "v.yaml", nominal()); }

const std::string kMass =
    "  vehicle.mass: {distribution: normal, mean: 1, sigma: 0.02, min: 0.95, max: 1.1, unit: nominal, "
    "source: "
    "estimate}\n";
const std::string kLatency =
    "  simulation.mocap.latency_s: {distribution: uniform, min: 0.005, max: 0.02, unit: s, source: "
    "estimate}\n";
const std::string kResistance =
    "  vehicle.battery.internal_resistance: {distribution: log_uniform, min: 0.06, max: 0.24, unit: ohm, "
    "source: \"a cold cell\"}\n";

TEST(DispersionFile, ReadsEveryDistribution) {
  const Dispersion dispersion = parse("name: room\nparameters:\n" + kLatency + kResistance + kMass);
  EXPECT_EQ(dispersion.name, "room");
  ASSERT_EQ(dispersion.distributions.size(), 3U);
  const ParameterDistribution& mass = dispersion.distributions[0];
  EXPECT_EQ(mass.what().name, "vehicle.mass") << "in the order of parameters(), not of the file";
  EXPECT_EQ(mass.distribution, Distribution::kNormal);
  EXPECT_TRUE(mass.of_nominal);
  EXPECT_EQ(mass.mean, 1.0);
  EXPECT_EQ(mass.sigma, 0.02);
  EXPECT_EQ(mass.min, 0.95);
  EXPECT_EQ(mass.max, 1.1);
  const ParameterDistribution& resistance = dispersion.distributions[1];
  EXPECT_EQ(resistance.what().name, "vehicle.battery.internal_resistance");
  EXPECT_EQ(resistance.distribution, Distribution::kLogUniform);
  EXPECT_FALSE(resistance.of_nominal);
  EXPECT_EQ(dispersion.distributions[2].distribution, Distribution::kUniform);
}

TEST(DispersionFile, UsesTheFileNameWithoutANameKey) { EXPECT_EQ(parse("parameters:\n" + kMass).name, "v"); }

TEST(DispersionFile, LoadsTheKayLionConfiguration) {
  const Dispersion dispersion =
      load_dispersion_file(tests::in_source("config/dispersion/kaylion.yaml"), nominal());
  EXPECT_EQ(dispersion.name, "kaylion");
  EXPECT_GE(dispersion.distributions.size(), 15U);
  for (std::uint64_t seed = 0; seed < 200; ++seed) EXPECT_EQ(draw(dispersion, nominal(), seed).rejected, 0);
}

TEST(DispersionFile, AcceptsEveryParameter) {
  for (const Parameter& parameter : parameters()) {
    World world = nominal();
    const bool is_zero = *parameter.in(world).front() == 0.0;
    const std::string unit = is_zero ? parameter.unit : "nominal";
    const std::string limits = is_zero ? "min: 0.01, max: 0.02" : "min: 0.99, max: 1";
    const Dispersion dispersion = parse("parameters:\n  " + parameter.name + ": {distribution: uniform, " +
                                        limits + ", unit: " + unit + ", source: estimate}\n");
    ASSERT_EQ(dispersion.distributions.size(), 1U);
    EXPECT_EQ(dispersion.distributions[0].what().name, parameter.name);
  }
}

TEST(DispersionFile, RefusesUnknownParametersAndListsTheKnown) {
  const std::string sentence = tests::refusal([] {
    parse("parameters:\n  vehicle.weight: {distribution: uniform, min: 1, max: 2, unit: kg, source: x}\n");
  });
  EXPECT_EQ(sentence.find("v.yaml:2: parameters.vehicle.weight: is unknown, must be one of vehicle.mass, "),
            0U)
      << sentence;
  for (const Parameter& parameter : parameters())
    EXPECT_NE(sentence.find(parameter.name), std::string::npos) << parameter.name;
}

std::string one(const std::string& key, const std::string& fields) {
  return "parameters:\n  " + key + ": {" + fields + "}\n";
}

class BadDispersionFile : public testing::TestWithParam<tests::Fault> {};

TEST_P(BadDispersionFile, IsRefusedWithASentence) {
  EXPECT_EQ(tests::refusal([] { parse(GetParam().text); }), GetParam().sentence);
}

INSTANTIATE_TEST_SUITE_P(
    , BadDispersionFile,
    testing::Values(
        tests::Fault{"NoParameters", "name: x\n", "v.yaml:1: parameters: is missing, must be given"},
        tests::Fault{"EmptyParameters", "parameters: {}\n",
                     "v.yaml:1: parameters: is empty, must name at least one parameter"},
        tests::Fault{"GivenTwice", "parameters:\n" + kMass + kMass,
                     "v.yaml:3: parameters.vehicle.mass: is given twice, first in line 2"},
        tests::Fault{
            "UnknownDistribution",
            one("vehicle.mass", "distribution: cauchy, min: 1, max: 2, unit: kg, source: x"),
            "v.yaml:2: parameters.vehicle.mass.distribution: is cauchy, must be uniform, log_uniform or "
            "normal"},
        tests::Fault{"WrongUnit",
                     one("vehicle.mass", "distribution: uniform, min: 30, max: 50, unit: g, source: x"),
                     "v.yaml:2: parameters.vehicle.mass.unit: is g, must be nominal or kg"},
        tests::Fault{"WholeInertiaInAUnit",
                     one("vehicle.inertia", "distribution: uniform, min: 1, max: 2, unit: kg*m^2, source: x"),
                     "v.yaml:2: parameters.vehicle.inertia.unit: is kg*m^2, must be nominal"},
        tests::Fault{"NoUnit", one("vehicle.mass", "distribution: uniform, min: 0.9, max: 1.1, source: x"),
                     "v.yaml:2: parameters.vehicle.mass.unit: is missing, must be given"},
        tests::Fault{"NoSource",
                     one("vehicle.mass", "distribution: uniform, min: 0.9, max: 1.1, unit: nominal"),
                     "v.yaml:2: parameters.vehicle.mass.source: is missing, must be given"},
        tests::Fault{"NoLimit",
                     one("vehicle.mass", "distribution: normal, mean: 1, sigma: 1, unit: nominal, source: x"),
                     "v.yaml:2: parameters.vehicle.mass.min: is missing, must be given"},
        tests::Fault{
            "MaxBelowMin",
            one("vehicle.mass", "distribution: uniform, min: 1.1, max: 0.9, unit: nominal, source: x"),
            "v.yaml:2: parameters.vehicle.mass.max: is 0.9, must be above 1.1"},
        tests::Fault{"LogarithmOfZero",
                     one("simulation.mocap.latency_s",
                         "distribution: log_uniform, min: 0, max: 1, unit: s, source: x"),
                     "v.yaml:2: parameters.simulation.mocap.latency_s.min: is 0, must be above 0"},
        tests::Fault{
            "MeanOutsideLimits",
            one("vehicle.mass",
                "distribution: normal, mean: 2, sigma: 0.1, min: 0.9, max: 1.1, unit: nominal, source: x"),
            "v.yaml:2: parameters.vehicle.mass.mean: is 2, must be at least 0.9 and at most 1.1"},
        tests::Fault{
            "SigmaTooLarge",
            one("vehicle.mass",
                "distribution: normal, mean: 1, sigma: 9, min: 0.75, max: 1.25, unit: nominal, source: x"),
            "v.yaml:2: parameters.vehicle.mass.sigma: is 9, must be above 0 and at most 0.5"},
        tests::Fault{
            "SigmaForUniform",
            one("vehicle.mass",
                "distribution: uniform, min: 0.9, max: 1.1, sigma: 1, unit: nominal, source: x"),
            "v.yaml:2: parameters.vehicle.mass.sigma: is unknown, must be one of distribution, unit, min, "
            "max or source"},
        tests::Fault{"NotANumber",
                     one("vehicle.mass", "distribution: uniform, min: .nan, max: 2, unit: kg, source: x"),
                     "v.yaml:2: parameters.vehicle.mass.min: is .nan, must be a finite number"},
        tests::Fault{
            "FactorOfNominalZero",
            one("simulation.mocap.dropout_probability",
                "distribution: uniform, min: 0.5, max: 2, unit: nominal, source: x"),
            "v.yaml:2: parameters.simulation.mocap.dropout_probability.unit: is nominal, must be 1: the "
            "nominal value is 0"},
        tests::Fault{
            "NegativeLatency",
            one("simulation.mocap.latency_s",
                "distribution: uniform, min: -0.01, max: 1, unit: s, source: x"),
            "v.yaml:2: parameters.simulation.mocap.latency_s.min: is -0.01, must be at least 0 and at most "
            "1"},
        tests::Fault{
            "WindBeyondTheLimit",
            one("simulation.air.wind_ned_m_s.east",
                "distribution: uniform, min: 0, max: 50, unit: m/s, source: x"),
            "v.yaml:2: parameters.simulation.air.wind_ned_m_s.east.max: is 50, must be at least -30 and at "
            "most 30"},
        tests::Fault{
            "FactorBeyondTheLimit",
            one("vehicle.motor.time_constant",
                "distribution: uniform, min: 0.01, max: 1, unit: nominal, source: x"),
            "v.yaml:2: parameters.vehicle.motor.time_constant.min: times the nominal value is 0.000821, "
            "must be "
            "a finite number of at least 0.001"},
        tests::Fault{
            "NegativeInertia",
            one("vehicle.inertia.xx", "distribution: uniform, min: -1, max: 1, unit: nominal, source: x"),
            "v.yaml:2: parameters.vehicle.inertia.xx.min: is -1, must be above 0"},
        tests::Fault{"UnknownRootKey", "parameters:\n" + kMass + "seed: 3\n",
                     "v.yaml:3: seed: is unknown, must be one of name or parameters"}),
    tests::name_of);

}  // namespace swiftlet::simulation::dispersion_file_test
