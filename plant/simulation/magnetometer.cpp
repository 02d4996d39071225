#include "swiftlet/plant/simulation/magnetometer.hpp"

#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::plant {

Magnetometer::Magnetometer(const MagnetometerSettings& settings, const Eigen::Vector3d& field_ned,
                           std::uint64_t seed)
    : field_ned_(field_ned),
      noise_gauss_(settings.noise_gauss),
      random_(seed, streams::kMagnetometer),
      bias_(settings.bias_sigma_gauss * random_.normal3()) {}

Eigen::Vector3d Magnetometer::sample(const Eigen::Quaterniond& q_ned_from_frd) {
  return q_ned_from_frd.conjugate() * field_ned_ + bias_ + noise_gauss_ * random_.normal3();
}

}  // namespace swiftlet::plant
