#include "swiftlet/plant/simulation/gps.hpp"

#include <cmath>

#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::plant {

Gps::Gps(const GpsSettings& settings, const SiteSettings& site, std::uint64_t seed)
    : settings_(settings),
      site_(site),
      decay_(std::exp(-1.0 / (settings.rate_hz * settings.drift_time_constant_s))),
      noise_(seed, streams::kGpsNoise),
      drift_(seed, streams::kGpsDrift),
      error_ned_(settings.position_drift_ned.cwiseProduct(drift_.normal3())) {}

GpsSample Gps::sample(const Eigen::Vector3d& position_ned, const Eigen::Vector3d& velocity_ned) {
  // The step that keeps the variance of the process at its stationary value.
  error_ned_ = decay_ * error_ned_ +
               std::sqrt(1.0 - decay_ * decay_) * settings_.position_drift_ned.cwiseProduct(drift_.normal3());
  const Eigen::Vector3d measured_ned =
      position_ned + error_ned_ + settings_.position_noise_ned.cwiseProduct(noise_.normal3());
  const Eigen::Vector3d accuracy =
      (settings_.position_drift_ned.cwiseAbs2() + settings_.position_noise_ned.cwiseAbs2()).cwiseSqrt();
  GpsSample sample;
  sample.position =
      math::position_at({site_.latitude_deg, site_.longitude_deg}, Eigen::Vector2d(measured_ned.head<2>()));
  sample.altitude_m = site_.altitude_m - measured_ned.z();
  sample.velocity_ned = velocity_ned + settings_.velocity_noise_ned.cwiseProduct(noise_.normal3());
  sample.horizontal_accuracy_m = accuracy.head<2>().norm();
  sample.vertical_accuracy_m = accuracy.z();
  return sample;
}

}  // namespace swiftlet::plant
