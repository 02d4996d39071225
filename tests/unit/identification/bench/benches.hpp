// Simulated benches for the tests of identification.
#pragma once

#include <vector>

#include "swiftlet/identification/bench/bench_simulation.hpp"
#include "tests/unit/identification/bench/sentences.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::tests {

inline identification::BenchData bench_of(const plant::Vehicle& vehicle, double share, std::uint64_t seed = 1,
                                          double outliers = 0.0) {
  identification::BenchNoise noise;
  noise.share = share;
  noise.outliers = outliers;
  return identification::simulate_bench(vehicle, noise, seed);
}

inline std::vector<double> times(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

}  // namespace swiftlet::tests
