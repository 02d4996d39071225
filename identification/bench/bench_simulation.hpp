// Simulates a test bench: generates noisy instrument readings of a vehicle with known parameters, to test the
// identification.
#pragma once

#include <cstdint>

#include "swiftlet/identification/bench/bench.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {

struct BenchNoise {
  // Standard deviation of each reading over the largest true reading of its column; for periods and masses,
  // over the true reading itself.
  double share = 0.005;
  double outliers = 0.0;  // fraction of the rows in which one reading is wrong by 20 to 60 % of full scale
};

// Simulates all experiments as in the paper: ESC at five supply voltages and nine throttles; steady motor at
// 40 voltages from a tenth to full; thrust and torque at 40 speeds; a step from rest to the hover voltage,
// sampled at 1 kHz; thrust over throttle at 45 points; 12 swings on two strings about each axis; 8 weighings.
// Set values (throttle, time, lengths) are exact; readings are noisy. The vehicle must pass
// plant::validate().
BenchData simulate_bench(const plant::Vehicle& vehicle, const BenchNoise& noise, std::uint64_t seed);

}  // namespace swiftlet::identification
