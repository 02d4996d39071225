// Samples of the parameter uncertainty in a vehicle file.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/dispersion.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::analysis::uncertainty_test {

plant::Vehicle kaylion() { return io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")); }

plant::VehicleUncertainty uncertainty() {
  plant::VehicleUncertainty out;
  out.parameters = {{"motor.k3", 2e-9, 2.777e-7, 2.857e-7},
                    {"motor.k2", 5e-6, 1.010e-3, 1.030e-3},
                    {"mass", 2e-4, 0.0396, 0.0404}};
  out.correlations = {{"motor.k2", "motor.k3", -0.9}};
  return out;
}

std::string refused(const plant::VehicleUncertainty& given) {
  try {
    simulation::dispersion_of(given, kaylion(), "v.yaml");
  } catch (const io::ConfigError& fault) {
    return fault.what();
  }
  ADD_FAILURE() << "expected ConfigError";
  return "";
}

TEST(Uncertainty, SamplesHaveItsVariancesAndCorrelations) {
  const plant::Vehicle vehicle = kaylion();
  const simulation::Dispersion dispersion = simulation::dispersion_of(uncertainty(), vehicle, "v.yaml");
  constexpr int kDraws = 4000;
  double k2 = 0.0;
  double k3 = 0.0;
  double mass = 0.0;
  double k2_k3 = 0.0;
  double k2_mass = 0.0;
  for (int seed = 0; seed < kDraws; ++seed) {
    const plant::Vehicle drawn =
        draw(dispersion, {vehicle, {}}, static_cast<std::uint64_t>(seed)).world.vehicle;
    const double e2 = (drawn.motor.k2 - vehicle.motor.k2) / 5e-6;
    const double e3 = (drawn.motor.k3 - vehicle.motor.k3) / 2e-9;
    const double em = (drawn.mass_kg - vehicle.mass_kg) / 2e-4;
    k2 += e2 * e2 / kDraws;
    k3 += e3 * e3 / kDraws;
    mass += em * em / kDraws;
    k2_k3 += e2 * e3 / kDraws;
    k2_mass += e2 * em / kDraws;
  }
  EXPECT_NEAR(k2, 1.0, 0.1);
  EXPECT_NEAR(k3, 1.0, 0.1);
  EXPECT_NEAR(mass, 1.0, 0.1);
  EXPECT_NEAR(k2_k3, -0.9, 0.1);
  EXPECT_NEAR(k2_mass, 0.0, 0.1);
}

TEST(Uncertainty, SampleDependsOnTheSeedAlone) {
  const plant::Vehicle vehicle = kaylion();
  const simulation::Dispersion dispersion = simulation::dispersion_of(uncertainty(), vehicle, "v.yaml");
  EXPECT_EQ(draw(dispersion, {vehicle, {}}, 7).values, draw(dispersion, {vehicle, {}}, 7).values);
  EXPECT_NE(draw(dispersion, {vehicle, {}}, 7).values, draw(dispersion, {vehicle, {}}, 8).values);
}

TEST(Uncertainty, RefusesFilesWithoutUncertainty) {
  EXPECT_EQ(refused({}),
            "v.yaml: uncertainty: is missing, must list the standard errors of the parameters; `swiftlet "
            "identify` writes it");
}

TEST(Uncertainty, RefusesParametersThatCannotVary) {
  plant::VehicleUncertainty given;
  given.parameters = {{"esc.pulse_min", 1.0, 1037.0, 1041.0}};
  EXPECT_EQ(refused(given), "v.yaml: uncertainty: esc.pulse_min cannot be varied");
}

}  // namespace swiftlet::analysis::uncertainty_test
