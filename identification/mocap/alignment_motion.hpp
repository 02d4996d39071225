// The motion between two poses and the pose that it predicts, with their derivatives, for align_body().
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/identification/mocap/motion_recording.hpp"
#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification::alignment {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Errors of a motion state, at the time of each pose, and of the parameters; index of the first component of each.
constexpr int kMotion = 15;
constexpr int kPosition = 0;
constexpr int kVelocity = 3;
constexpr int kAttitude = 6;  // rotation vector in body axes
constexpr int kForceBias = 9;
constexpr int kRateBias = 12;
constexpr int kParameters = 9;
constexpr int kMisalignment = 0;
constexpr int kLeverArm = 3;
constexpr int kVertical = 6;
constexpr int kDelay = 8;

using Motion = Eigen::Matrix<double, kMotion, 1>;
using MotionMatrix = Eigen::Matrix<double, kMotion, kMotion>;
using MotionParameters = Eigen::Matrix<double, kMotion, kParameters>;
using Parameters = Eigen::Matrix<double, kParameters, 1>;
using ParameterMatrix = Eigen::Matrix<double, kParameters, kParameters>;
using Residual = Eigen::Matrix<double, 6, 1>;

// Least noise: that of usual sensors. That of the force is four times as large: it allows for vibration, and for noise of the
// attitude that would pass for tilt.
constexpr double kForceNoise = 1.6e-2;  // m/s^2/sqrt(Hz)
constexpr double kRateNoise = 2e-4;     // rad/s/sqrt(Hz)

struct Noise {
  double force = kForceNoise;  // density
  double rate = kRateNoise;    // density
  double position_m = 2e-4;    // of a pose, each axis
  double orientation_rad = 1e-3;
  double position_growth = 1.0;  // of variances, because errors of neighbouring poses are alike
  double orientation_growth = 1.0;

  Residual variances() const {
    Residual out;
    out << Vector3d::Constant(position_m * position_m * position_growth),
        Vector3d::Constant(orientation_rad * orientation_rad * orientation_growth);
    return out;
  }
};

struct State {
  Vector3d position = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();
  Quaterniond attitude = Quaterniond::Identity();
  Vector3d force_bias = Vector3d::Zero();
  Vector3d rate_bias = Vector3d::Zero();
  Vector3d force = Vector3d::Zero();  // reading at the time, with bias
  Vector3d rates = Vector3d::Zero();

  Motion minus(const State& other) const {
    Motion out;
    out << position - other.position, velocity - other.velocity,
        math::rotation_vector(other.attitude.conjugate() * attitude), force_bias - other.force_bias,
        rate_bias - other.rate_bias;
    return out;
  }
  void add(const Motion& error) {
    position += error.segment<3>(kPosition);
    velocity += error.segment<3>(kVelocity);
    attitude = (attitude * math::rotation(error.segment<3>(kAttitude))).normalized();
    force_bias += error.segment<3>(kForceBias);
    rate_bias += error.segment<3>(kRateBias);
  }
};

struct Sought {
  Quaterniond misalignment = Quaterniond::Identity();  // vehicle attitude = pose attitude * misalignment
  Vector3d lever_arm = Vector3d::Zero();
  Eigen::Vector2d vertical = Eigen::Vector2d::Zero();
  double delay_s = 0.0;

  Vector3d gravity() const { return plant::kGravity * Vector3d(vertical.x(), vertical.y(), 1.0); }
  Parameters vector() const {
    Parameters out;
    out << math::rotation_vector(misalignment), lever_arm, vertical, delay_s;
    return out;
  }
  void add(const Parameters& error) {
    misalignment = (misalignment * math::rotation(error.segment<3>(kMisalignment))).normalized();
    lever_arm += error.segment<3>(kLeverArm);
    vertical += error.segment<2>(kVertical);
    delay_s += error[kDelay];
  }
};

// The state after an interval, with the derivatives of its errors and their variances.
struct Propagation {
  State state;
  MotionMatrix transition = MotionMatrix::Identity();
  Eigen::Matrix<double, kMotion, 2> by_vertical = Eigen::Matrix<double, kMotion, 2>::Zero();
  Motion variance = Motion::Zero();
};

Propagation propagate(const State& from, const MotionRecording::Interval& interval, const Sought& sought,
                      const Noise& noise);

// A pose minus that of the state, with the derivatives of the latter.
struct Observation {
  Residual residual;
  Eigen::Matrix<double, 6, kMotion> by_motion = Eigen::Matrix<double, 6, kMotion>::Zero();
  Eigen::Matrix<double, 6, kParameters> by_parameters = Eigen::Matrix<double, 6, kParameters>::Zero();
};
Observation observe(const FlightPose& pose, const State& state, const Sought& sought);

}  // namespace swiftlet::identification::alignment
