#include "swiftlet/plant/simulation/barometer.hpp"

#include <cmath>

#include "swiftlet/plant/simulation/atmosphere.hpp"
#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::plant {

Barometer::Barometer(const BarometerSettings& settings, std::uint64_t seed)
    : noise_pa_(settings.noise_pa),
      walk_pa_(settings.bias_walk_pa / std::sqrt(settings.rate_hz)),
      random_(seed, streams::kBarometer),
      bias_pa_(settings.bias_sigma_pa * random_.normal()) {}

BarometerSample Barometer::sample(double altitude_m) {
  bias_pa_ += walk_pa_ * random_.normal();
  BarometerSample sample;
  sample.pressure_pa = atmosphere::pressure_pa(altitude_m) + bias_pa_ + noise_pa_ * random_.normal();
  sample.altitude_m = atmosphere::altitude_m(sample.pressure_pa);
  sample.temperature_c = atmosphere::temperature_k(altitude_m) - atmosphere::kCelsius_k;
  return sample;
}

}  // namespace swiftlet::plant
