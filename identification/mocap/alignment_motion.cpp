#include "swiftlet/identification/mocap/alignment_motion.hpp"

namespace swiftlet::identification::alignment {
namespace {

using Eigen::Matrix3d;

constexpr double kForceBiasWalk = 1e-3;  // m/s^2/sqrt(s)
constexpr double kRateBiasWalk = 1e-4;   // rad/s/sqrt(s)

Matrix3d hat(const Vector3d& v) {
  Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

}  // namespace

Propagation propagate(const State& from, const MotionRecording::Interval& interval, const Sought& sought,
                      const Noise& noise) {
  Propagation out;
  out.state = from;
  const double dt = interval.duration_s;
  out.variance.segment<3>(kForceBias).setConstant(kForceBiasWalk * kForceBiasWalk * dt);
  out.variance.segment<3>(kRateBias).setConstant(kRateBiasWalk * kRateBiasWalk * dt);
  if (interval.is_gap) {
    out.variance.segment<3>(kPosition).setConstant(100.0);
    out.variance.segment<3>(kVelocity).setConstant(100.0);
    out.variance.segment<3>(kAttitude).setConstant(10.0);
    return out;
  }
  Vector3d velocity_change = Vector3d::Zero();  // by specific force
  for (const MotionRecording::Reading& reading : interval.readings) {
    const Vector3d turn = reading.dt * (reading.rates - from.rate_bias);
    const Vector3d force =
        out.state.attitude * math::rotation(0.5 * turn) * (reading.force - from.force_bias);
    const Vector3d acceleration = force + sought.gravity();
    out.state.position += reading.dt * (out.state.velocity + 0.5 * reading.dt * acceleration);
    out.state.velocity += reading.dt * acceleration;
    out.state.attitude = out.state.attitude * math::rotation(turn);
    velocity_change += reading.dt * force;
  }
  out.state.attitude.normalize();
  const Matrix3d from_body = from.attitude.toRotationMatrix();
  MotionMatrix& F = out.transition;
  F.block<3, 3>(kVelocity, kAttitude) = -hat(velocity_change) * from_body;
  F.block<3, 3>(kVelocity, kForceBias) = -dt * from_body;
  F.block<3, 3>(kPosition, kVelocity) = dt * Matrix3d::Identity();
  F.block<3, 3>(kPosition, kAttitude) = 0.5 * dt * F.block<3, 3>(kVelocity, kAttitude);
  F.block<3, 3>(kPosition, kForceBias) = 0.5 * dt * F.block<3, 3>(kVelocity, kForceBias);
  F.block<3, 3>(kAttitude, kAttitude) = (out.state.attitude.conjugate() * from.attitude).toRotationMatrix();
  F.block<3, 3>(kAttitude, kRateBias) = -dt * Matrix3d::Identity();
  out.by_vertical.block<2, 2>(kVelocity, 0) = dt * plant::kGravity * Eigen::Matrix2d::Identity();
  out.by_vertical.block<2, 2>(kPosition, 0) = 0.5 * dt * dt * plant::kGravity * Eigen::Matrix2d::Identity();
  const double force_variance = noise.force * noise.force * dt;
  out.variance.segment<3>(kPosition).setConstant(force_variance * dt * dt / 3.0 + 1e-12);
  out.variance.segment<3>(kVelocity).setConstant(force_variance);
  out.variance.segment<3>(kAttitude).setConstant(noise.rate * noise.rate * dt);
  return out;
}

Observation observe(const FlightPose& pose, const State& state, const Sought& sought) {
  const double delay_s = sought.delay_s;
  const Vector3d rates = state.rates - state.rate_bias;
  const Vector3d acceleration = state.attitude * (state.force - state.force_bias) + sought.gravity();
  const Quaterniond ahead = math::rotation(delay_s * rates);
  const Quaterniond attitude = state.attitude * ahead.conjugate();
  const Vector3d position =
      state.position - delay_s * state.velocity + 0.5 * delay_s * delay_s * acceleration;
  Observation out;
  out.residual << pose.position_ned - (position - attitude * sought.lever_arm),
      math::rotation_vector(sought.misalignment * attitude.conjugate() * pose.q_ned_from_frd);
  const Matrix3d from_vehicle = attitude.toRotationMatrix();
  const Matrix3d swing = from_vehicle * hat(sought.lever_arm);
  const Matrix3d turn = ahead.toRotationMatrix();
  const Matrix3d body_from_vehicle = sought.misalignment.toRotationMatrix();
  out.by_motion.block<3, 3>(0, kPosition).setIdentity();
  out.by_motion.block<3, 3>(0, kVelocity) = -delay_s * Matrix3d::Identity();
  out.by_motion.block<3, 3>(0, kAttitude) = swing * turn;
  out.by_motion.block<3, 3>(3, kAttitude) = body_from_vehicle * turn;
  out.by_parameters.block<3, 3>(0, kLeverArm) = -from_vehicle;
  out.by_parameters.block<3, 1>(0, kDelay) = -state.velocity + delay_s * acceleration - swing * rates;
  out.by_parameters.block<3, 3>(3, kMisalignment) = -body_from_vehicle;
  out.by_parameters.block<3, 1>(3, kDelay) = -body_from_vehicle * rates;
  return out;
}

}  // namespace swiftlet::identification::alignment
