#include "swiftlet/math/euler.hpp"

#include <cmath>

namespace swiftlet::math {
namespace {

constexpr double kGimbalCosine = 1e-6;  // cos(theta) below which psi is set to 0

}  // namespace

double wrap_angle(double angle_rad) {
  return std::abs(angle_rad) <= M_PI ? angle_rad : std::remainder(angle_rad, 2.0 * M_PI);
}

EulerAngles euler_angles(const Eigen::Quaterniond& q_ned_from_frd) {
  const Eigen::Matrix3d r = q_ned_from_frd.toRotationMatrix();
  const double cosine = std::sqrt(r(2, 1) * r(2, 1) + r(2, 2) * r(2, 2));
  EulerAngles out;
  out.pitch_rad = std::atan2(-r(2, 0), cosine);
  if (cosine < kGimbalCosine) {
    out.roll_rad = out.pitch_rad > 0.0 ? std::atan2(r(0, 1), r(1, 1)) : std::atan2(-r(0, 1), r(1, 1));
    return out;
  }
  out.roll_rad = std::atan2(r(2, 1), r(2, 2));
  out.heading.yaw_rad = std::atan2(r(1, 0), r(0, 0));
  out.heading.cosine = r(0, 0) / cosine;
  out.heading.sine = r(1, 0) / cosine;
  return out;
}

Eigen::Quaterniond quaternion_from_euler(const Eigen::Vector3d& euler_rad) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return AngleAxisd(euler_rad[2], Vector3d::UnitZ()) * AngleAxisd(euler_rad[1], Vector3d::UnitY()) *
         AngleAxisd(euler_rad[0], Vector3d::UnitX());
}

}  // namespace swiftlet::math
