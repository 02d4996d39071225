// Wind model: a steady wind plus gusts. Each axis of the gusts is an Ornstein-Uhlenbeck process, the
// first-order form of Dryden's longitudinal model.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

class WindModel {
 public:
  WindModel(const AirSettings& settings, double step_s, std::uint64_t seed);

  // Advances to the wind of the next integration step.
  void advance() {
    if (gusty_) draw();
  }
  const Eigen::Vector3d& wind_ned() const { return wind_ned_; }  // m/s

 private:
  void draw();

  bool gusty_;
  Eigen::Vector3d mean_ned_;
  Eigen::Vector3d sigma_ned_;
  double decay_;          // factor of a gust over one step
  double noise_gain_;     // sqrt(1 - decay_^2), keeps the variance constant
  Eigen::Vector3d gust_;  // gust over sigma
  Eigen::Vector3d wind_ned_;
  RandomStream random_;
};

}  // namespace swiftlet::plant
