// Butterworth low pass of second order on a vector, with the rate of its output.
#pragma once

#include <Eigen/Core>

namespace swiftlet::control {

struct SecondOrderFilter {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  // of value, 1/s

  // value'' = w^2 (input - value) - sqrt(2) w value' over dt_s, stable for bandwidth dt_s < 1. bandwidth: w, rad/s.
  void step(double dt_s, double bandwidth, const Eigen::Vector3d& input) {
    constexpr double kRootOf2 = 1.4142135623730951;
    rate += dt_s * bandwidth * (bandwidth * (input - value) - kRootOf2 * rate);
    value += dt_s * rate;
  }
};

}  // namespace swiftlet::control
