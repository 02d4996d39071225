// A body that cameras see, fixed to a vehicle.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/plant/model/samples.hpp"
#include "tests/support/mocap/natnet_server.hpp"

namespace swiftlet::tests::filmed_body {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using plant::PoseSample;

constexpr std::int32_t kBody = 42;

inline const Vector3d kLeverArm(0.01, -0.02, 0.03);
inline const Vector3d kMisalignment(0.0, 0.0, 0.35);  // rad

struct Pose {
  Vector3d position;
  Quaterniond attitude;
};

// The pose of the body that is fixed to the vehicle like this, with the noise of cameras: they see no pose twice.
inline Pose body_of(const PoseSample& vehicle) {
  constexpr double kNoiseM = 2e-5;
  const double phase = 1e-6 * static_cast<double>(vehicle.stamp_ns);
  const Vector3d noise = kNoiseM * Vector3d(std::sin(phase), std::sin(2.0 * phase), std::cos(phase));
  const Quaterniond& attitude = vehicle.q_ned_from_frd;
  const Quaterniond turn(Eigen::AngleAxisd(kMisalignment.norm(), kMisalignment.normalized()));
  return {vehicle.position_ned - attitude * kLeverArm + noise, attitude * turn.conjugate()};
}

// Forward, up, right; forward, left, up.
inline Pose with_y_up(const Pose& ned) {
  const auto turned = [](const Vector3d& v) { return Vector3d(v.x(), -v.z(), v.y()); };
  Pose pose{turned(ned.position), Quaterniond(ned.attitude.w(), 0, 0, 0)};
  pose.attitude.vec() = turned(ned.attitude.vec());
  return pose;
}
inline Pose with_z_up(const Pose& ned) {
  const auto turned = [](const Vector3d& v) { return Vector3d(v.x(), -v.y(), -v.z()); };
  Pose pose{turned(ned.position), Quaterniond(ned.attitude.w(), 0, 0, 0)};
  pose.attitude.vec() = turned(ned.attitude.vec());
  return pose;
}

inline natnet::Frame frame_of(natnet::Body body, std::int32_t number, const Pose& pose) {
  for (int i = 0; i < 3; ++i) body.position[i] = static_cast<float>(pose.position[i]);
  for (int i = 0; i < 4; ++i) body.q_xyzw[i] = static_cast<float>(pose.attitude.coeffs()[i]);
  natnet::Frame frame;
  frame.number = number;
  frame.bodies = {body};
  return frame;
}

}  // namespace swiftlet::tests::filmed_body
