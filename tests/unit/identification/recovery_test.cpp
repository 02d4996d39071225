// Whether the bench's identification finds what was put in, and knows how well: bias and coverage over many seeds.
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "identification/bench.hpp"
#include "identification/bench_simulation.hpp"
#include "tests/unit/plant_model/vehicles.hpp"

namespace swiftlet::identification {
namespace {

struct Tally {
  int count = 0;
  int covered = 0;
  double error = 0.0;   // sum of relative errors
  double square = 0.0;  // of their squares
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

std::map<std::string, Tally> recover(const plant::Vehicle& truth, const BenchNoise& noise, int seeds) {
  const std::map<std::string, double> expected = truth_of(truth);
  std::map<std::string, Tally> tallies;
  for (int seed = 1; seed <= seeds; ++seed) {
    const BenchIdentification found =
        identify_bench(simulate_bench(truth, noise, static_cast<std::uint64_t>(seed)), truth);
    for (const plant::ParameterUncertainty& p : found.uncertainty.parameters) {
      const double value = expected.at(p.parameter);
      Tally& tally = tallies[p.parameter];
      const double error = 0.5 * (p.low + p.high) / value - 1.0;
      ++tally.count;
      tally.covered += p.low <= value && value <= p.high ? 1 : 0;
      tally.error += error;
      tally.square += error * error;
    }
  }
  return tallies;
}

TEST(Recovery, Explore) {
  for (const double outliers : {0.0, 0.05})
    for (const double share : {0.005, 0.02}) {
      BenchNoise noise;
      noise.share = share;
      noise.outliers = outliers;
      for (const auto& [name, tally] : recover(tests::kaylion(), noise, 400)) {
        std::printf("%g %g %-22s n %d bias %+.3f %% sd %.3f %% covered %.1f %%\n", share, outliers, name.c_str(),
                    tally.count, 100 * tally.error / tally.count, 100 * std::sqrt(tally.square / tally.count),
                    100.0 * tally.covered / tally.count);
      }
    }
}

}  // namespace
}  // namespace swiftlet::identification
