#include "control/estimation/error_covariance.hpp"

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
template <std::size_t kColumns>
inline void advance_columns(const ErrorInterval& interval,
                            std::array<std::array<double, kColumns>, kErrorStates>& x) {
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
  for (std::size_t c = 0; c < kColumns; ++c) {
    const double g0 = r00 * x[9][c] + r01 * x[10][c] + r02 * x[11][c];
    const double g1 = r10 * x[9][c] + r11 * x[10][c] + r12 * x[11][c];
    const double g2 = r20 * x[9][c] + r21 * x[10][c] + r22 * x[11][c];
    const double a0 = r00 * x[12][c] + r01 * x[13][c] + r02 * x[14][c];
    const double a1 = r10 * x[12][c] + r11 * x[13][c] + r12 * x[14][c];
    const double a2 = r20 * x[12][c] + r21 * x[13][c] + r22 * x[14][c];
    const double h0 = x[6][c] - third_t * g0;
    const double h1 = x[7][c] - third_t * g1;
    const double h2 = x[8][c] - third_t * g2;
    x[0][c] += t * x[3][c] - (s1 * h2 - s2 * h1) - half_t2 * a0;
    x[1][c] += t * x[4][c] - (s2 * h0 - s0 * h2) - half_t2 * a1;
    x[2][c] += t * x[5][c] - (s0 * h1 - s1 * h0) - half_t2 * a2;
    const double w0 = x[6][c] - half_t * g0;
    const double w1 = x[7][c] - half_t * g1;
    const double w2 = x[8][c] - half_t * g2;
    x[3][c] -= (u1 * w2 - u2 * w1) + t * a0;
    x[4][c] -= (u2 * w0 - u0 * w2) + t * a1;
    x[5][c] -= (u0 * w1 - u1 * w0) + t * a2;
    x[6][c] -= t * g0;
    x[7][c] -= t * g1;
    x[8][c] -= t * g2;
  }
}

}  // namespace

ErrorState advance(const ErrorInterval& interval, const ErrorState& error) {
  std::array<std::array<double, 1>, kErrorStates> x{};
  for (std::size_t i = 0; i < kErrorStates; ++i) x[i][0] = error[static_cast<Eigen::Index>(i)];
  advance_columns(interval, x);
  ErrorState out;
  for (std::size_t i = 0; i < kErrorStates; ++i) out[static_cast<Eigen::Index>(i)] = x[i][0];
  return out;
}

void ErrorCovariance::reset(const ErrorState& standard_deviation) {
  for (auto& row : p_) row.fill(0.0);
  for (std::size_t i = 0; i < kErrorStates; ++i) {
    const double sigma = standard_deviation[static_cast<Eigen::Index>(i)];
    p_[i][i] = sigma * sigma;
  }
}

void ErrorCovariance::reset_motion(const Eigen::Matrix<double, 9, 1>& standard_deviation) {
  for (std::size_t i = 0; i < kErrorStates; ++i) {
    for (std::size_t j = 0; j < kErrorStates; ++j) {
      if (std::min(i, j) < kGyroBias) p_[i][j] = 0.0;
    }
  }
  for (std::size_t i = 0; i < kGyroBias; ++i) {
    const double sigma = standard_deviation[static_cast<Eigen::Index>(i)];
    p_[i][i] = sigma * sigma;
  }
}

// From the left to all columns; then from the right to the rows that it changes, as columns of their
// transpose. What comes out of the upper triangle is written to both.
void ErrorCovariance::advance(const ErrorInterval& interval, const ErrorNoise& noise) {
  advance_columns(interval, p_);
  constexpr std::size_t kChanged = kGyroBias;
  alignas(32) std::array<std::array<double, kChanged + 1>, kErrorStates> transposed;
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

// S = H P H' + N = L L'. The rows are L^-1 (H P), with L^-1 innovation as their last column, by forward
// substitution.
ErrorCovariance::Correction ErrorCovariance::weigh(const PoseInnovation& innovation, double position_variance,
                                                   double rotation_variance) const {
  constexpr std::size_t kRows = Correction::kRows;
  constexpr std::array<std::size_t, kRows> kMeasured = {kPosition, kPosition + 1, kPosition + 2,
                                                        kRotation, kRotation + 1, kRotation + 2};
  Correction out;
  std::array<std::array<double, kRows>, kRows> s;
  for (std::size_t i = 0; i < kRows; ++i) {
    out.rows_[i] = p_[kMeasured[i]];
    out.rows_[i][kErrorStates] = i < 3 ? innovation.position[static_cast<Eigen::Index>(i)]
                                       : innovation.rotation[static_cast<Eigen::Index>(i - 3)];
    for (std::size_t j = 0; j <= i; ++j) s[i][j] = p_[kMeasured[i]][kMeasured[j]];
    s[i][i] += i < 3 ? position_variance : rotation_variance;
  }
  for (std::size_t i = 0; i < kRows; ++i) {
    const double inverse = 1.0 / std::sqrt(s[i][i]);
    for (std::size_t c = 0; c < kStride; ++c) out.rows_[i][c] *= inverse;
    for (std::size_t k = i + 1; k < kRows; ++k) {
      const double l = s[k][i] * inverse;
      for (std::size_t c = 0; c < kStride; ++c) out.rows_[k][c] -= l * out.rows_[i][c];
      for (std::size_t j = i + 1; j <= k; ++j) s[k][j] -= l * (s[j][i] * inverse);
    }
    out.normalised_square_ += out.rows_[i][kErrorStates] * out.rows_[i][kErrorStates];
  }
  return out;
}

ErrorState ErrorCovariance::Correction::step() const {
  std::array<double, kErrorStates + 1> sum{};
  for (const auto& row : rows_) {
    for (std::size_t c = 0; c <= kErrorStates; ++c) sum[c] += row[kErrorStates] * row[c];
  }
  return Eigen::Map<const ErrorState>(sum.data());
}

void ErrorCovariance::reduce(const Correction& correction) {
  const auto& w = correction.rows_;
  for (std::size_t i = 0; i < kErrorStates; ++i) {
    for (std::size_t c = 0; c < kStride; ++c) {
      p_[i][c] -= w[0][i] * w[0][c] + w[1][i] * w[1][c] + w[2][i] * w[2][c] + w[3][i] * w[3][c] +
                  w[4][i] * w[4][c] + w[5][i] * w[5][c];
    }
    p_[i][kErrorStates] = 0.0;
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
