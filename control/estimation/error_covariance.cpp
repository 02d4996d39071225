#include "swiftlet/control/estimation/error_covariance.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::control {
namespace {

constexpr std::size_t kPosition = 0;
constexpr std::size_t kVelocity = 3;
constexpr std::size_t kRotation = 6;
constexpr std::size_t kGyroBias = 9;
constexpr std::size_t kAccelerometerBias = 12;

// Moves errors that stand in the columns of x over the interval. With T, R, u and U of the interval,
//   rotation' = rotation - T R gyro_bias
//   velocity' = velocity - u x (rotation - T/2 R gyro_bias) - T R accelerometer_bias
//   position' = position + T velocity - U x (rotation - T/3 R gyro_bias) - T^2/2 R accelerometer_bias,
// which is exact for constant f and R.
template <int kColumns>
inline void advance_columns(const ErrorInterval& interval,
                            std::array<Eigen::Array<double, kColumns, 1>, kErrorStates>& x) {
  const double t = interval.duration_s;
  const double half_t = t / 2;
  const double third_t = t / 3;
  const double half_t2 = t * t / 2;
  const double u0 = interval.velocity_change[0];
  const double u1 = interval.velocity_change[1];
  const double u2 = interval.velocity_change[2];
  const double s0 = interval.position_change[0];
  const double s1 = interval.position_change[1];
  const double s2 = interval.position_change[2];
  const Eigen::Matrix3d& r = interval.r_ned_from_frd;
  const double r00 = r(0, 0), r01 = r(0, 1), r02 = r(0, 2);
  const double r10 = r(1, 0), r11 = r(1, 1), r12 = r(1, 2);
  const double r20 = r(2, 0), r21 = r(2, 1), r22 = r(2, 2);
  constexpr int kWidth = kColumns % 2 == 0 ? 2 : 1;  // columns at once, as many as a register holds
  using Columns = Eigen::Array<double, kWidth, 1>;
  for (int c = 0; c < kColumns; c += kWidth) {
    const auto at = [&](std::size_t row) { return x[row].template segment<kWidth>(c); };
    const Columns b0 = at(9), b1 = at(10), b2 = at(11);
    const Columns g0 = r00 * b0 + r01 * b1 + r02 * b2;
    const Columns g1 = r10 * b0 + r11 * b1 + r12 * b2;
    const Columns g2 = r20 * b0 + r21 * b1 + r22 * b2;
    const Columns d0 = at(12), d1 = at(13), d2 = at(14);
    const Columns a0 = r00 * d0 + r01 * d1 + r02 * d2;
    const Columns a1 = r10 * d0 + r11 * d1 + r12 * d2;
    const Columns a2 = r20 * d0 + r21 * d1 + r22 * d2;
    const Columns h0 = at(6) - third_t * g0;
    const Columns h1 = at(7) - third_t * g1;
    const Columns h2 = at(8) - third_t * g2;
    at(0) += t * at(3) - (s1 * h2 - s2 * h1) - half_t2 * a0;
    at(1) += t * at(4) - (s2 * h0 - s0 * h2) - half_t2 * a1;
    at(2) += t * at(5) - (s0 * h1 - s1 * h0) - half_t2 * a2;
    const Columns w0 = at(6) - half_t * g0;
    const Columns w1 = at(7) - half_t * g1;
    const Columns w2 = at(8) - half_t * g2;
    at(3) -= (u1 * w2 - u2 * w1) + t * a0;
    at(4) -= (u2 * w0 - u0 * w2) + t * a1;
    at(5) -= (u0 * w1 - u1 * w0) + t * a2;
    at(6) -= t * g0;
    at(7) -= t * g1;
    at(8) -= t * g2;
  }
}

}  // namespace

ErrorState advance(const ErrorInterval& interval, const ErrorState& error) {
  std::array<Eigen::Array<double, 1, 1>, kErrorStates> x;
  for (std::size_t i = 0; i < kErrorStates; ++i) x[i][0] = error[static_cast<Eigen::Index>(i)];
  advance_columns(interval, x);
  ErrorState out;
  for (std::size_t i = 0; i < kErrorStates; ++i) out[static_cast<Eigen::Index>(i)] = x[i][0];
  return out;
}

void ErrorCovariance::reset(const ErrorState& standard_deviation) {
  for (Row& row : p_) row.setZero();
  for (std::size_t i = 0; i < kErrorStates; ++i) {
    const double sigma = standard_deviation[static_cast<Eigen::Index>(i)];
    p_[i][i] = sigma * sigma;
  }
}

// From the left to all columns; then from the right to the rows that it changes, as columns of their
// transpose. What comes out of the upper triangle is written to both.
void ErrorCovariance::advance(const ErrorInterval& interval, const ErrorNoise& noise) {
  advance_columns(interval, p_);
  constexpr std::size_t kChanged = kGyroBias;
  std::array<Eigen::Array<double, kChanged + 1, 1>, kErrorStates> transposed;
  for (std::size_t i = 0; i < kErrorStates; ++i) {
    for (std::size_t j = 0; j < kChanged; ++j) transposed[i][j] = p_[j][i];
    transposed[i][kChanged] = 0.0;
  }
  advance_columns(interval, transposed);
  for (std::size_t i = 0; i < kErrorStates; ++i) {
    for (std::size_t j = 0; j <= std::min(i, kChanged - 1); ++j) p_[i][j] = p_[j][i] = transposed[i][j];
  }

  const double t = std::abs(interval.duration_s);
  for (std::size_t k = 0; k < 3; ++k) {
    p_[kPosition + k][kPosition + k] += noise.velocity * t * t * t / 3;
    p_[kPosition + k][kVelocity + k] += noise.velocity * t * t / 2;
    p_[kVelocity + k][kPosition + k] = p_[kPosition + k][kVelocity + k];
    p_[kVelocity + k][kVelocity + k] += noise.velocity * t;
    p_[kRotation + k][kRotation + k] += noise.rotation * t;
    p_[kGyroBias + k][kGyroBias + k] += noise.gyro_bias * t;
    p_[kAccelerometerBias + k][kAccelerometerBias + k] += noise.accelerometer_bias * t;
  }
}

void ErrorCovariance::add_motion(double position_variance, double velocity_variance,
                                 double rotation_variance) {
  for (std::size_t k = 0; k < 3; ++k) {
    p_[kPosition + k][kPosition + k] += position_variance;
    p_[kVelocity + k][kVelocity + k] += velocity_variance;
    p_[kRotation + k][kRotation + k] += rotation_variance;
  }
}

// S = H P H' + N = L D L'. The rows are D^-1/2 L^-1 (H P), with D^-1/2 L^-1 innovation as their last column,
// by forward substitution.
ErrorCovariance::Correction ErrorCovariance::weigh(const PoseInnovation& innovation, double position_variance,
                                                   double rotation_variance) const {
  constexpr std::size_t kRows = Correction::kRows;
  constexpr std::array<std::size_t, kRows> kMeasured = {kPosition, kPosition + 1, kPosition + 2,
                                                        kRotation, kRotation + 1, kRotation + 2};
  Correction out;
  std::array<std::array<double, kRows>, kRows> s;
  for (std::size_t i = 0; i < kRows; ++i) {
    out.rows_[i] = p_[kMeasured[i]];
    for (std::size_t j = 0; j <= i; ++j) s[i][j] = p_[kMeasured[i]][kMeasured[j]];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    out.rows_[i][kErrorStates] = innovation.position[i];
    out.rows_[3 + i][kErrorStates] = innovation.rotation[i];
    s[i][i] += position_variance;
    s[3 + i][3 + i] += rotation_variance;
  }
  for (std::size_t i = 0; i < kRows; ++i) {
    const double inverse = 1.0 / s[i][i];
    for (std::size_t k = i + 1; k < kRows; ++k) {
      const double l = s[k][i] * inverse;
      for (std::size_t j = i + 1; j <= k; ++j) s[k][j] -= l * s[j][i];
      out.rows_[k] -= l * out.rows_[i];
    }
  }
  for (std::size_t i = 0; i < kRows; ++i) {
    out.rows_[i] *= 1.0 / std::sqrt(s[i][i]);
    out.normalised_square_ += out.rows_[i][kErrorStates] * out.rows_[i][kErrorStates];
  }
  return out;
}

ErrorState ErrorCovariance::Correction::step() const {
  Row sum = Row::Zero();
  for (const Row& row : rows_) sum += row[kErrorStates] * row;
  return sum.head<kErrorStates>();
}

// What stands in four rows from the first one's diagonal on.
template <int kFirst>
void ErrorCovariance::reduce_rows(const Correction& correction) {
  constexpr int kWidth = kErrorStates + 1 - kFirst;
  const auto& w = correction.rows_;
  for (int i = kFirst; i < std::min(kFirst + 4, kErrorStates); ++i) {
    p_[i].tail<kWidth>() -= w[0][i] * w[0].tail<kWidth>() + w[1][i] * w[1].tail<kWidth>() +
                            w[2][i] * w[2].tail<kWidth>() + w[3][i] * w[3].tail<kWidth>() +
                            w[4][i] * w[4].tail<kWidth>() + w[5][i] * w[5].tail<kWidth>();
    p_[i][kErrorStates] = 0.0;
  }
}

void ErrorCovariance::reduce(const Correction& correction) {
  reduce_rows<0>(correction);
  reduce_rows<4>(correction);
  reduce_rows<8>(correction);
  reduce_rows<12>(correction);
  for (int i = 4; i < kErrorStates; ++i) {
    for (int j = 0; j < i / 4 * 4; ++j) p_[i][j] = p_[j][i];
  }
}

ErrorState ErrorCovariance::standard_deviation() const {
  ErrorState out;
  for (std::size_t i = 0; i < kErrorStates; ++i) {
    out[static_cast<Eigen::Index>(i)] = std::sqrt(std::max(p_[i][i], 0.0));
  }
  return out;
}

Eigen::Matrix<double, kErrorStates, kErrorStates> ErrorCovariance::matrix() const {
  Eigen::Matrix<double, kErrorStates, kErrorStates> out;
  for (std::size_t i = 0; i < kErrorStates; ++i) {
    for (std::size_t j = 0; j < kErrorStates; ++j) {
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = p_[i][j];
    }
  }
  return out;
}

}  // namespace swiftlet::control
