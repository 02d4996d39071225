#include "swiftlet/control/estimation/error_covariance.hpp"

#include <cmath>

#include <Eigen/Cholesky>

namespace swiftlet::control {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Offsets of the error's parts.
constexpr int kPosition = 0;
constexpr int kVelocity = 3;
constexpr int kRotation = 6;
constexpr int kGyroBias = 9;
constexpr int kAccelerometerBias = 12;

// [v]x
Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

// The 3x3 blocks of F that are neither 0 nor I.
struct Transition {
  double position_velocity;  // times I
  Matrix3d position_rotation, position_gyro_bias, position_accelerometer_bias;
  Matrix3d velocity_rotation, velocity_gyro_bias, velocity_accelerometer_bias;
  Matrix3d rotation_gyro_bias;
};

Transition transition(const ErrorInterval& interval) {
  const double t = interval.duration_s;
  const Matrix3d& r = interval.r_ned_from_frd;
  const Matrix3d s_cross = cross_matrix(interval.position_change);
  const Matrix3d u_cross = cross_matrix(interval.velocity_change);
  Transition f;
  f.position_velocity = t;
  f.position_rotation = -s_cross;
  f.position_gyro_bias = t / 3 * s_cross * r;
  f.position_accelerometer_bias = -t * t / 2 * r;
  f.velocity_rotation = -u_cross;
  f.velocity_gyro_bias = t / 2 * u_cross * r;
  f.velocity_accelerometer_bias = -t * r;
  f.rotation_gyro_bias = -t * r;
  return f;
}

// F X, for errors in the columns of X.
template <class Columns>
Columns product(const Transition& f, const Columns& x) {
  const auto velocity = x.template middleRows<3>(kVelocity);
  const auto rotation = x.template middleRows<3>(kRotation);
  const auto gyro_bias = x.template middleRows<3>(kGyroBias);
  const auto accelerometer_bias = x.template middleRows<3>(kAccelerometerBias);
  Columns out = x;
  auto out_position = out.template middleRows<3>(kPosition);
  auto out_velocity = out.template middleRows<3>(kVelocity);
  auto out_rotation = out.template middleRows<3>(kRotation);
  out_position += f.position_velocity * velocity;
  out_position.noalias() += f.position_rotation * rotation;
  out_position.noalias() += f.position_gyro_bias * gyro_bias;
  out_position.noalias() += f.position_accelerometer_bias * accelerometer_bias;
  out_velocity.noalias() += f.velocity_rotation * rotation;
  out_velocity.noalias() += f.velocity_gyro_bias * gyro_bias;
  out_velocity.noalias() += f.velocity_accelerometer_bias * accelerometer_bias;
  out_rotation.noalias() += f.rotation_gyro_bias * gyro_bias;
  return out;
}

// Removes the asymmetry that rounding has caused.
ErrorMatrix symmetric(const ErrorMatrix& m) { return 0.5 * (m + m.transpose()); }

}  // namespace

ErrorState advance(const ErrorInterval& interval, const ErrorState& error) {
  return product(transition(interval), error);
}

void ErrorCovariance::reset(const ErrorState& standard_deviation) {
  p_ = standard_deviation.cwiseAbs2().asDiagonal();
}

// P <- F P F' + Q, computed as F (F P)', since P is symmetric.
void ErrorCovariance::advance(const ErrorInterval& interval, const ErrorNoise& noise) {
  const Transition f = transition(interval);
  const ErrorMatrix f_p = product(f, p_);
  p_ = symmetric(product<ErrorMatrix>(f, f_p.transpose()));

  // Q, of white noise on velocity, rotation and the biases' rates
  const double t = std::abs(interval.duration_s);
  const auto add = [this](int row, int column, double variance) {
    p_.block<3, 3>(row, column).diagonal().array() += variance;
  };
  add(kPosition, kPosition, noise.velocity * t * t * t / 3);
  add(kPosition, kVelocity, noise.velocity * t * t / 2);
  add(kVelocity, kPosition, noise.velocity * t * t / 2);
  add(kVelocity, kVelocity, noise.velocity * t);
  add(kRotation, kRotation, noise.rotation * t);
  add(kGyroBias, kGyroBias, noise.gyro_bias * t);
  add(kAccelerometerBias, kAccelerometerBias, noise.accelerometer_bias * t);
}

void ErrorCovariance::add_motion(double position_variance, double velocity_variance,
                                 double rotation_variance) {
  p_.diagonal().segment<3>(kPosition).array() += position_variance;
  p_.diagonal().segment<3>(kVelocity).array() += velocity_variance;
  p_.diagonal().segment<3>(kRotation).array() += rotation_variance;
}

ErrorCovariance::Update ErrorCovariance::compute_update(const PoseInnovation& innovation,
                                                        double position_variance,
                                                        double rotation_variance) const {
  Update out;
  out.h_p_ << p_.middleRows<3>(kPosition), p_.middleRows<3>(kRotation);
  Matrix6 s;  // S = H P H' + V
  s << out.h_p_.middleCols<3>(kPosition), out.h_p_.middleCols<3>(kRotation);
  s.diagonal().head<3>().array() += position_variance;
  s.diagonal().tail<3>().array() += rotation_variance;
  const Eigen::LLT<Matrix6> s_factors(s);
  out.gain_ = s_factors.solve(out.h_p_).transpose();  // K = P H' S^-1

  Eigen::Matrix<double, 6, 1> z;
  z << innovation.position, innovation.rotation;
  out.step_ = out.gain_ * z;
  out.normalised_square_ = z.dot(s_factors.solve(z));
  return out;
}

// K S = P H'
void ErrorCovariance::apply_update(const Update& correction) {
  p_ = symmetric(p_ - correction.gain_ * correction.h_p_);
}

}  // namespace swiftlet::control
