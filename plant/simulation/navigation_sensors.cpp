#include "swiftlet/plant/simulation/navigation_sensors.hpp"

namespace swiftlet::plant {

NavigationSensors::NavigationSensors(const SimulationSettings& settings, std::uint64_t seed)
    : site_altitude_m_(settings.site.altitude_m),
      barometer_(settings.barometer, seed),
      magnetometer_(settings.magnetometer, settings.site.magnetic_field_ned, seed),
      barometer_schedule_{period_ns(settings.barometer.rate_hz)},
      magnetometer_schedule_{period_ns(settings.magnetometer.rate_hz)},
      gps_schedule_{period_ns(settings.gps.rate_hz)} {
  if (settings.gps.rate_hz > 0.0) gps_.emplace(settings.gps, settings.site, seed);
}

NavigationSamples NavigationSensors::sample(const TruthSample& truth) {
  NavigationSamples samples;
  if (barometer_schedule_.due(truth.stamp_ns))
    samples.barometer = barometer_.sample(site_altitude_m_ - truth.position_ned.z());
  if (magnetometer_schedule_.due(truth.stamp_ns))
    samples.magnetic_field_frd = magnetometer_.sample(truth.q_ned_from_frd);
  if (gps_schedule_.due(truth.stamp_ns)) samples.gps = gps_->sample(truth.position_ned, truth.velocity_ned);
  return samples;
}

}  // namespace swiftlet::plant
