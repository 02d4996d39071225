#include "swiftlet/identification/bench/inertia.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/identification/bench/mass.hpp"
#include "tests/unit/identification/bench/benches.hpp"

namespace swiftlet::identification::inertia_test {

using tests::bench_of;
using tests::contains;
using tests::kaylion;
using tests::refused;

InertiaTarget target(double mass_error = 0.0) { return {"inertia.zz", "J_z", 0.040, mass_error, 0.0695}; }

SwingData swing(double inertia, const std::vector<double>& arms) {
  SwingData data;
  for (const double arm : arms) {
    data.arm_m.push_back(arm);
    data.period_s.push_back(2.0 * M_PI * std::sqrt((inertia + 0.040 * arm * arm) / (0.040 * 9.80665 * arm)));
  }
  return data;
}

TEST(InertiaExperiment, IdentifiesInertiaFromABifilarPendulum) {
  const Experiment found = identify_inertia(*bench_of(kaylion(), 0.0).inertia[2]->bifilar, target());
  EXPECT_NEAR(found.estimate("inertia.zz").value / 8.8e-5, 1.0, 1e-9);
}

TEST(InertiaExperiment, IdentifiesInertiaFromAPhysicalPendulum) {
  const Experiment found = identify_inertia(swing(8.8e-5, {0.05, 0.06, 0.08, 0.1}), target());
  EXPECT_NEAR(found.estimate("inertia.zz").value / 8.8e-5, 1.0, 1e-8);
  EXPECT_TRUE(found.warnings.empty());
}

TEST(InertiaExperiment, WarnsWhenLongArmsHideTheInertia) {
  EXPECT_TRUE(contains(identify_inertia(swing(8.8e-5, {0.5, 0.6, 0.8, 1.0}), target()).warnings, "hides it"));
}

TEST(InertiaExperiment, PropagatesTheErrorOfTheMass) {
  const ParameterEstimate found =
      identify_inertia(*bench_of(kaylion(), 0.0).inertia[2]->bifilar, target(0.02)).estimates.front();
  EXPECT_NEAR(found.standard_error / found.value, 0.02, 1e-9);
}

TEST(InertiaExperiment, RefusesCentimetresTakenForMetres) {
  BifilarData data = *bench_of(kaylion(), 0.005).inertia[2]->bifilar;
  data.separation_m = tests::times(data.separation_m, 100.0);
  EXPECT_NE(refused([&] { identify_inertia(data, target()); }).find("radius of gyration"), std::string::npos);
}

TEST(MassExperiment, IsTheMeanWithStudentsInterval) {
  const Experiment found = identify_mass({0.0398, 0.0401, 0.0400, 0.0403, 0.0398});
  EXPECT_NEAR(found.estimate("mass").value, 0.0400, 1e-12);
  EXPECT_GT(found.estimate("mass").half_width, 2.776 * 2.1e-4 / std::sqrt(5.0));
}

TEST(MassExperiment, WarnsThatEqualReadingsHideTheirSpread) {
  const Experiment found = identify_mass({0.04, 0.04, 0.04, 0.04});
  EXPECT_EQ(found.estimate("mass").value, 0.04);
  EXPECT_TRUE(contains(found.warnings, "the balance's resolution hides their spread"));
}

}  // namespace swiftlet::identification::inertia_test
