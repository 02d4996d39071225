#include "swiftlet/plant/simulation/imu.hpp"

#include <cmath>

#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::plant {

Imu::Imu(const ImuSettings& settings, std::uint64_t seed)
    : accelerometer_{settings.accelerometer_noise_density * std::sqrt(settings.rate_hz),
                     settings.accelerometer_bias_walk * std::sqrt(kWalkSamples / settings.rate_hz),
                     settings.accelerometer_range,
                     math::RandomStream(seed, streams::kAccelerometerNoise),
                     math::RandomStream(seed, streams::kAccelerometerBias),
                     Eigen::Vector3d::Zero()},
      gyro_{settings.gyro_noise_density * std::sqrt(settings.rate_hz),
            settings.gyro_bias_walk * std::sqrt(kWalkSamples / settings.rate_hz),
            settings.gyro_range,
            math::RandomStream(seed, streams::kGyroNoise),
            math::RandomStream(seed, streams::kGyroBias),
            Eigen::Vector3d::Zero()} {
  accelerometer_.bias = settings.accelerometer_bias_sigma * accelerometer_.walk.normal3();
  gyro_.bias = settings.gyro_bias_sigma * gyro_.walk.normal3();
}

Eigen::Vector3d Imu::Sensor::measure(const Eigen::Vector3d& truth, bool walks) {
  if (walks && walk_sigma > 0.0) bias += walk_sigma * walk.normal3();
  Eigen::Vector3d measured = truth + bias;
  if (noise_sigma > 0.0) measured += noise_sigma * noise.normal3();
  return measured.cwiseMax(-range).cwiseMin(range);
}

ImuSample Imu::sample(std::int64_t stamp_ns, const Eigen::Vector3d& specific_force_frd,
                      const Eigen::Vector3d& body_rates_frd) {
  ImuSample sample;
  sample.stamp_ns = stamp_ns;
  sample.sequence = ++sequence_;
  const bool walks = sequence_ % kWalkSamples == 0;
  sample.specific_force_frd = accelerometer_.measure(specific_force_frd, walks);
  sample.body_rates_frd = gyro_.measure(body_rates_frd, walks);
  return sample;
}

}  // namespace swiftlet::plant
