// Inertial measurement unit at the centre of mass with axes aligned to the body. Models white noise, a
// constant bias drawn once per run, a bias random walk (updated every kWalkSamples samples) and saturation.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

class Imu {
 public:
  Imu(const ImuSettings& settings, std::uint64_t seed);

  // Returns the next sample. Call it once per period of the IMU rate.
  ImuSample sample(std::int64_t stamp_ns, const Eigen::Vector3d& specific_force_frd,
                   const Eigen::Vector3d& body_rates_frd);

  const Eigen::Vector3d& accelerometer_bias() const { return accelerometer_.bias; }  // m/s^2, last sample's
  const Eigen::Vector3d& gyro_bias() const { return gyro_.bias; }                    // rad/s, last sample's

  static constexpr int kWalkSamples = 10;  // updating the walk at every sample makes no visible difference

 private:
  struct Sensor {
    double noise_sigma;
    double walk_sigma;  // standard deviation of one step of the walk
    double range;
    math::RandomStream noise;
    math::RandomStream walk;
    Eigen::Vector3d bias;

    Eigen::Vector3d measure(const Eigen::Vector3d& truth, bool walks);
  };

  Sensor accelerometer_;
  Sensor gyro_;
  std::uint64_t sequence_ = 0;
};

}  // namespace swiftlet::plant
