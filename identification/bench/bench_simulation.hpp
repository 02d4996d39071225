// A test bench in the computer: what its instruments would read of a vehicle, noise and all. To try the
// identification on parameters that are known.
#pragma once

#include <cstdint>

#include "swiftlet/identification/bench/bench.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {

struct BenchNoise {
  double share =
      0.005;  // standard deviation of each reading, over the largest true reading of its column; of periods and masses
  double outliers = 0.0;  // share of the rows of which one reading is wrong by 20 to 60 % of full scale
};

// All experiments, laid out as in the paper: ESC at five supply voltages and nine throttles; 40 voltages from
// a tenth to full for the steady motor; 40 speeds for thrust and torque; a step from rest to the hover
// voltage, sampled at 1 kHz; 45 thrusts over throttle; 12 swings on two strings for each axis; 8 weighings.
// What is set (throttle, time, lengths) is exact; what is read is noisy. The vehicle is one that
// plant::validate() passes.
BenchData simulate_bench(const plant::Vehicle& vehicle, const BenchNoise& noise, std::uint64_t seed);

}  // namespace swiftlet::identification
