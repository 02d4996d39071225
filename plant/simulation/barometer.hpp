// Barometer in the standard atmosphere. Models white noise, a constant bias drawn once per run, which stands
// for the weather as well, and a random walk of the bias.
#pragma once

#include <cstdint>

#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

struct BarometerSample {
  double pressure_pa = 0.0;
  double altitude_m = 0.0;     // of this pressure in the standard atmosphere, above mean sea level
  double temperature_c = 0.0;  // of the standard atmosphere at the vehicle
};

class Barometer {
 public:
  Barometer(const BarometerSettings& settings, std::uint64_t seed);

  // Returns the next sample. Call it once per period of its rate. altitude_m: above mean sea level, true.
  BarometerSample sample(double altitude_m);

 private:
  double noise_pa_;
  double walk_pa_;  // standard deviation of one step of the walk
  math::RandomStream random_;
  double bias_pa_;
};

}  // namespace swiftlet::plant
