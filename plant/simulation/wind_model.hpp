// Wind model: a steady wind plus gusts. Each axis of the gusts is an Ornstein-Uhlenbeck process, the
// first-order form of Dryden's longitudinal model, or the gusts are those of Dryden's model at low altitude: first order
// along the wind, second order across it and vertically.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

// Correlation times of Dryden's model at low altitude, s: length over airspeed, along the wind, across it, and vertically.
Eigen::Vector3d dryden_times_s(const DrydenSettings& settings);

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
  void update();

  bool gusty_;
  bool dryden_;
  Eigen::Vector3d mean_ned_;
  Eigen::Vector3d sigma_ned_;
  Eigen::Array3d decay_;       // factor of a gust over one step, each axis
  Eigen::Array3d noise_gain_;  // sqrt(1 - decay_^2), keeps the variance constant
  Eigen::Vector3d
      gust_;  // gust over sigma; of Dryden's model along the wind, and the first states of the others
  Eigen::Vector3d lagged_;  // of Dryden's model: gust_ behind a second lag of the same time
  Eigen::Vector2d along_;   // unit vector of the horizontal wind, NED
  Eigen::Vector3d wind_ned_;
  math::RandomStream random_;
};

}  // namespace swiftlet::plant
