// From a bench to a flight: an unknown vehicle is measured and identified, gains are designed, and it flies.
#include <algorithm>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/ground/batch/margin_study.hpp"
#include "swiftlet/ground/flight/in_process_flight.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/identification/bench/bench.hpp"
#include "swiftlet/identification/bench/bench_simulation.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/settings/vehicle_writer.hpp"
#include "swiftlet/math/random.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::analysis::bench_to_flight_test {

// A vehicle with randomly perturbed parameters of `like`.
plant::Vehicle perturbed(const plant::Vehicle& like, std::uint64_t seed) {
  math::RandomStream random(seed, 20250920);
  plant::Vehicle out = like;
  const auto scale = [&](double& value, double by) { value *= random.uniform(1.0 - by, 1.0 + by); };
  scale(out.mass_kg, 0.1);
  for (int axis = 0; axis < 3; ++axis) scale(out.inertia(axis, axis), 0.1);
  out.inertia *= random.uniform(0.8, 1.2);
  out.inertia(2, 2) = std::min(out.inertia(2, 2), 0.98 * (out.inertia(0, 0) + out.inertia(1, 1)));
  scale(out.rotor.thrust, 0.1);
  scale(out.rotor.torque, 0.1);
  scale(out.motor.time_constant_s, 0.2);
  scale(out.motor.k2, 0.1);
  scale(out.motor.k3, 0.1);
  out.motor.armature_resistance_ohm = 0.99 * out.motor.k2 * out.motor.k3 / out.rotor.torque;
  scale(out.esc.gain, 0.05);
  scale(out.esc.offset_v2, 0.1);
  return out;
}

// The identified vehicle's file, as `swiftlet identify --out` writes it.
std::string identified_file(const tests::TemporaryFolder& folder, const plant::Vehicle& truth,
                            const plant::Vehicle& base, std::uint64_t seed) {
  identification::BenchNoise noise;
  noise.share = 0.005;
  const identification::BenchData bench = identification::simulate_bench(truth, noise, seed);
  identification::BenchIdentification found = identification::identify_bench(bench, base);
  found.vehicle.name = "identified";
  return folder.write("identified.yaml",
                      io::vehicle_text(found.vehicle, found.sources, found.uncertainty, ""));
}

ground::LaunchConfiguration plan_of(const std::string& vehicle, const tests::TemporaryFolder& folder,
                                    const std::string& dispersion = "") {
  ground::FlyOptions options;
  options.launch_mode = ground::LaunchMode::kInProcess;
  options.vehicle = vehicle;
  options.dispersion = dispersion;
  options.record = folder.path().string();
  return ground::plan_flight(options);
}

FlightReport fly(const ground::LaunchConfiguration& plan, const plant::Vehicle& truth, std::uint64_t seed) {
  simulation::ClosedLoop loop(truth, plan.vehicle, plan.simulation, plan.control, seed);
  record::Flight flight;
  return ground::fly_in_process(loop, plan, seed, flight, nullptr, {});
}

class BenchToFlight : public testing::TestWithParam<std::uint64_t> {
 protected:
  tests::TemporaryFolder folder_;
  plant::Vehicle kaylion_ = io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml"));
  plant::Vehicle truth_ = perturbed(kaylion_, GetParam());
};

TEST_P(BenchToFlight, FliesTheSquareOnTheTruePlant) {
  ASSERT_TRUE(plant::validate(truth_).empty());
  const ground::LaunchConfiguration plan =
      plan_of(identified_file(folder_, truth_, kaylion_, GetParam()), folder_);
  const FlightReport report = fly(plan, truth_, GetParam());
  EXPECT_TRUE(report.completed) << report.reason;
  EXPECT_LT(report.errors.rms_3d_m, 0.004);
  EXPECT_LT(report.errors.peak_3d_m, 0.02);
}

TEST_P(BenchToFlight, KeepsItsMarginsWithinTheBenchUncertainty) {
  const std::string file = identified_file(folder_, truth_, kaylion_, GetParam());
  const ground::LaunchConfiguration plan = plan_of(file, folder_, simulation::kUncertainty);
  ASSERT_EQ(plan.dispersion.name, simulation::kUncertainty);
  const ground::MarginStudy study = ground::study_margins(control::design(plan.vehicle, plan.control),
                                                          plan.vehicle, plan.dispersion, 300, GetParam());
  EXPECT_EQ(study.samples, 300U);
  EXPECT_EQ(study.unstable, 0U);
  for (std::size_t i = 0; i < ground::kLoopNames.size(); ++i) {
    const ground::MarginStudy::Loop& loop = study.loops[i];
    EXPECT_GT(loop.worst.phase_deg, 20.0) << ground::kLoopNames[i];
    EXPECT_GT(loop.worst.delay_s, 0.01) << ground::kLoopNames[i];
    EXPECT_LE(loop.worst.phase_deg, loop.most.phase_deg) << ground::kLoopNames[i];
    EXPECT_LE(loop.worst.delay_s, loop.most.delay_s) << ground::kLoopNames[i];
    EXPECT_GE(loop.worst.gain_decrease, loop.most.gain_decrease) << ground::kLoopNames[i];
    // A bench with 0.5 % noise hardly changes the margins.
    EXPECT_NEAR(loop.most.phase_deg, loop.designed.phase_deg, 3.0) << ground::kLoopNames[i];
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, BenchToFlight, testing::Values(1, 2, 3, 4, 5));

}  // namespace swiftlet::analysis::bench_to_flight_test
