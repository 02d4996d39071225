// Inertial measurement unit at the centre of mass, its axes the body's: white noise, a constant bias drawn
// once a run, a bias that wanders (in steps of kWalkSamples), saturation.
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

  // The next sample, one period of the settings' rate after the last.
  ImuSample sample(std::int64_t stamp_ns, const Eigen::Vector3d& specific_force_frd,
                   const Eigen::Vector3d& body_rates_frd);

  const Eigen::Vector3d& accelerometer_bias() const { return accelerometer_.bias; }  // of the last sample
  const Eigen::Vector3d& gyro_bias() const { return gyro_.bias; }

  static constexpr int kWalkSamples = 10;  // to draw each time would show nowhere

 private:
  struct Sensor {
    double noise_sigma;
    double walk_sigma;  // of one step
    double range;
    RandomStream noise;
    RandomStream walk;
    Eigen::Vector3d bias;

    Eigen::Vector3d measure(const Eigen::Vector3d& truth, bool walks);
  };

  Sensor accelerometer_;
  Sensor gyro_;
  std::uint64_t sequence_ = 0;
};

}  // namespace swiftlet::plant
