// Butterworth low pass of second order on a vector, with the rate of its output.
#pragma once

#include <Eigen/Core>

namespace swiftlet::control {

struct SecondOrderFilter {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();  // rate of value over the bandwidth
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();   // of value, 1/s

  // value'' = w^2 (input - value) - sqrt(2) w value' over dt_s > 0 by the implicit Euler method. bandwidth: w > 0,
  // rad/s. Stable for any step and any w that changes from step to step: in value and slope, w only scales time.
  void step(double dt_s, double bandwidth, const Eigen::Vector3d& input) {
    constexpr double kRootOf2 = 1.4142135623730951;
    const double angle = bandwidth * dt_s;
    slope = (slope + angle * (input - value)) / (1.0 + kRootOf2 * angle + angle * angle);
    value += angle * slope;
    rate = bandwidth * slope;
  }
};

}  // namespace swiftlet::control
