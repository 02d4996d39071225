// Satellite navigation receiver at the centre of mass. Models white noise of position and velocity, and an error
// of the position that changes slowly: a first-order Gauss-Markov process.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "swiftlet/math/geodesy.hpp"
#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

struct GpsSample {
  math::GeographicPosition position;
  double altitude_m = 0.0;                                 // above mean sea level
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();  // m/s
  // Standard deviations of the position's whole error, m.
  double horizontal_accuracy_m = 0.0;
  double vertical_accuracy_m = 0.0;
};

class Gps {
 public:
  // Precondition: settings.rate_hz > 0.
  Gps(const GpsSettings& settings, const SiteSettings& site, std::uint64_t seed);

  // Returns the next sample. Call it once per period of its rate.
  GpsSample sample(const Eigen::Vector3d& position_ned, const Eigen::Vector3d& velocity_ned);

 private:
  GpsSettings settings_;
  SiteSettings site_;
  double decay_;  // of the slow error over a period
  math::RandomStream noise_;
  math::RandomStream drift_;
  Eigen::Vector3d error_ned_;  // slow
};

}  // namespace swiftlet::plant
