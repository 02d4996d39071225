// Benches that the tests of identification/ share.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "identification/bench_simulation.hpp"
#include "tests/unit/plant_model/vehicles.hpp"

namespace swiftlet::tests {

inline identification::BenchData bench_of(const plant::Vehicle& vehicle, double share, std::uint64_t seed = 1,
                                          double outliers = 0.0) {
  identification::BenchNoise noise;
  noise.share = share;
  noise.outliers = outliers;
  return identification::simulate_bench(vehicle, noise, seed);
}

// The sentence with which data are refused; fails the test if they are not.
inline std::string refused(const std::function<void()>& work) {
  try {
    work();
  } catch (const identification::BadData& fault) {
    return fault.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

inline bool contains(const std::vector<std::string>& sentences, const std::string& part) {
  for (const std::string& sentence : sentences) {
    if (sentence.find(part) != std::string::npos) return true;
  }
  return false;
}

inline std::vector<double> times(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

}  // namespace swiftlet::tests
