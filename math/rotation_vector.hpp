// Conversion between rotation vectors, rad, and unit quaternions.
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace swiftlet::math {

// Unit quaternion of a rotation vector: (cos h, sin(h) / h * half) with half = vector / 2 and h = |half|.
// Small vectors use series; the first omitted term is below 1e-16.
inline Eigen::Quaterniond rotation(const Eigen::Vector3d& vector) {
  constexpr double kLargestForSeries = 0.01;  // h^2
  const Eigen::Vector3d half = 0.5 * vector;
  const double h2 = half.squaredNorm();
  double cosine =
      1.0 - 0.5 * h2 * (1.0 - (1.0 / 12) * h2 * (1.0 - (1.0 / 30) * h2 * (1.0 - (1.0 / 56) * h2)));
  double sine_over_h =
      1.0 - (1.0 / 6) * h2 * (1.0 - (1.0 / 20) * h2 * (1.0 - (1.0 / 42) * h2 * (1.0 - (1.0 / 72) * h2)));
  if (h2 > kLargestForSeries) {
    const double h = std::sqrt(h2);
    cosine = std::cos(h);
    sine_over_h = std::sin(h) / h;
  }
  return {cosine, sine_over_h * half.x(), sine_over_h * half.y(), sine_over_h * half.z()};
}

// Normalises a quaternion whose length differs from 1 by rounding errors only, such as a product of unit
// quaternions.
inline Eigen::Quaterniond renormalised(const Eigen::Quaterniond& q) {
  return Eigen::Quaterniond((0.5 * (3.0 - q.squaredNorm())) * q.coeffs());
}

// Rotation vector of a unit quaternion, at most pi long. The relative error is below 1e-9.
inline Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q) {
  constexpr double kLargestForSeries = 1e-3;  // s^2
  const double s2 = q.vec().squaredNorm();
  double angle_over_s = 2.0 * (1.0 + s2 * (1.0 / 6 + s2 * (3.0 / 40)));
  if (s2 > kLargestForSeries || std::abs(q.w()) < 0.5) {
    const double s = std::sqrt(s2);
    angle_over_s = 2.0 * std::atan2(s, std::abs(q.w())) / s;
  }
  return (q.w() < 0.0 ? -angle_over_s : angle_over_s) * q.vec();
}

}  // namespace swiftlet::math
