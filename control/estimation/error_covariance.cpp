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
constexpr int kMoving = 9;  // position, velocity and rotation
constexpr int kBiases = 6;

// Row-major, so that the rows of a part of the error lie side by side.
template <int kRows, int kColumns>
using Rows = Eigen::Matrix<double, kRows, kColumns, kColumns == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

// v x each column of m.
template <int kColumns>
Rows<3, kColumns> cross(const Vector3d& v, const Rows<3, kColumns>& m) {
  Rows<3, kColumns> out;
  out.row(0) = v.y() * m.row(2) - v.z() * m.row(1);
  out.row(1) = v.z() * m.row(0) - v.x() * m.row(2);
  out.row(2) = v.x() * m.row(1) - v.y() * m.row(0);
  return out;
}

// F X without its last six rows, which are those of X. The columns of X are errors. The blocks of F that multiply the biases
// are products with R: rate = R gyro_bias and acceleration = R accelerometer_bias are computed once.
template <int kColumns>
Rows<kMoving, kColumns> moved(const ErrorInterval& interval, const Rows<kErrorStates, kColumns>& x) {
  const auto part = [&x](int first) { return x.template middleRows<3>(first); };
  const double t = interval.duration_s;
  const Vector3d& u = interval.velocity_change;
  const Vector3d& s = interval.position_change;
  const Rows<3, kColumns> rotation = part(kRotation);
  const Rows<3, kColumns> rate = interval.r_ned_from_frd.lazyProduct(part(kGyroBias));
  const Rows<3, kColumns> acceleration = interval.r_ned_from_frd.lazyProduct(part(kAccelerometerBias));
  Rows<kMoving, kColumns> out;
  out.template middleRows<3>(kPosition) = part(kPosition) + t * part(kVelocity) -
                                          cross<kColumns>(s, rotation - t / 3 * rate) -
                                          t * t / 2 * acceleration;
  out.template middleRows<3>(kVelocity) =
      part(kVelocity) - cross<kColumns>(u, rotation - t / 2 * rate) - t * acceleration;
  out.template middleRows<3>(kRotation) = rotation - t * rate;
  return out;
}

// Copies the elements below the diagonal to those above it.
void mirror(ErrorMatrix& m) {
  for (int i = 0; i < kErrorStates; ++i) {
    for (int j = 0; j < i; ++j) m(j, i) = m(i, j);
  }
}

}  // namespace

ErrorState advance(const ErrorInterval& interval, const ErrorState& error) {
  ErrorState out = error;
  out.head<kMoving>() = moved<1>(interval, error);
  return out;
}

void ErrorCovariance::reset(const ErrorState& standard_deviation) {
  p_ = standard_deviation.cwiseAbs2().asDiagonal();
}

// P <- F P F' + Q, computed as F (F P)', since P is symmetric. Without the blocks of F that are 0 or I, and with the update
// below by W, a pose takes 0.37 of the instructions of dense products, and a flight in one process 13 % fewer in all.
void ErrorCovariance::advance(const ErrorInterval& interval, const ErrorNoise& noise) {
  const Rows<kMoving, kErrorStates> f_p = moved<kErrorStates>(interval, p_);
  p_.topLeftCorner<kMoving, kMoving>() = moved<kMoving>(interval, f_p.transpose());  // F changes no bias
  p_.bottomLeftCorner<kBiases, kMoving>() = f_p.rightCols<kBiases>().transpose();
  mirror(p_);

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
  Matrix6 s;  // S = H P H' + V
  s << p_.block<3, 3>(kPosition, kPosition), p_.block<3, 3>(kPosition, kRotation),
      p_.block<3, 3>(kRotation, kPosition), p_.block<3, 3>(kRotation, kRotation);
  s.diagonal().head<3>().array() += position_variance;
  s.diagonal().tail<3>().array() += rotation_variance;
  const Matrix6 l = s.llt().matrixL();

  // W = L^-1 H P and w = L^-1 z, row by row
  Update out;
  out.w_ << p_.middleRows<3>(kPosition), p_.middleRows<3>(kRotation);
  Eigen::Matrix<double, 6, 1> w;
  w << innovation.position, innovation.rotation;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < i; ++k) {
      out.w_.row(i) -= l(i, k) * out.w_.row(k);
      w[i] -= l(i, k) * w[k];
    }
    const double scale = 1.0 / l(i, i);
    out.w_.row(i) *= scale;
    w[i] *= scale;
  }
  out.step_ = out.w_.transpose() * w;
  out.normalised_square_ = w.squaredNorm();
  return out;
}

// P <- P - W' W by the rows of each part of the error, up to the diagonal: P is symmetric.
void ErrorCovariance::apply_update(const Update& correction) {
  const auto& w = correction.w_;
  for (int part = 0; part < kErrorStates; part += 3) {
    p_.middleRows<3>(part).leftCols(part + 3) -=
        w.middleCols<3>(part).transpose().lazyProduct(w.leftCols(part + 3));
  }
  mirror(p_);
}

}  // namespace swiftlet::control
