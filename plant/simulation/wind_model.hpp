// The air's motion: a steady wind and gusts. Each gust axis is an Ornstein-Uhlenbeck process, the first-order
// relative of Dryden's longitudinal model.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

class WindModel {
 public:
  WindModel(const AirSettings& settings, double step_s, std::uint64_t seed);

  // The wind that holds over the next step; draws the gusts if there are any.
  void advance() {
    if (gusty_) draw();
  }
  const Eigen::Vector3d& wind_ned() const { return wind_ned_; }  // m/s

 private:
  void draw();

  bool gusty_;
  Eigen::Vector3d mean_ned_;
  Eigen::Vector3d sigma_ned_;
  double keep_;           // of a gust, over a step
  double renew_;          // so that the variance stays
  Eigen::Vector3d gust_;  // over sigma
  Eigen::Vector3d wind_ned_;
  RandomStream random_;
};

}  // namespace swiftlet::plant
