// Magnetometer with axes aligned to the body in a uniform field. Models white noise and a constant bias, drawn
// once per run, as of magnetised parts of the vehicle.
#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

class Magnetometer {
 public:
  // field_ned: gauss.
  Magnetometer(const MagnetometerSettings& settings, const Eigen::Vector3d& field_ned, std::uint64_t seed);

  // Returns the next sample, gauss in FRD.
  Eigen::Vector3d sample(const Eigen::Quaterniond& q_ned_from_frd);

  const Eigen::Vector3d& bias() const { return bias_; }

 private:
  Eigen::Vector3d field_ned_;
  double noise_gauss_;
  math::RandomStream random_;
  Eigen::Vector3d bias_;
};

}  // namespace swiftlet::plant
