#include "swiftlet/control/planning/spline.hpp"

#include <array>
#include <cstddef>

#include <Eigen/Cholesky>

#include "swiftlet/math/linear_algebra.hpp"

namespace swiftlet::control {
namespace {

// n (n - 1) ... (n - k + 1)
double falling(int n, int k) {
  double product = 1.0;
  for (int i = 0; i < k; ++i) product *= n - i;
  return product;
}

// The derivative whose square is integrated: 3 for jerk, 4 for snap.
constexpr int kLargestOrder = 4;

// A segment of duration 1. Coefficients and cost are functions of the ends' derivatives of order 0 .. R - 1, those at
// the start first.
struct UnitSegment {
  using Matrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2 * kLargestOrder, 2 * kLargestOrder>;
  int R;
  Matrix coefficients;  // from the ends' derivatives
  Matrix cost;          // d' cost d is the integral of the squared R-th derivative

  explicit UnitSegment(int order) : R(order) {
    Matrix ends = Matrix::Zero(2 * R, 2 * R);  // derivatives from coefficients
    Matrix integral = ends;
    for (int k = 0; k < R; ++k) {
      ends(k, k) = falling(k, k);
      for (int i = k; i < 2 * R; ++i) ends(R + k, i) = falling(i, k);
    }
    for (int i = R; i < 2 * R; ++i) {
      for (int j = R; j < 2 * R; ++j) integral(i, j) = falling(i, R) * falling(j, R) / (i + j - 2 * R + 1);
    }
    coefficients = math::solve(Eigen::MatrixXd(ends), Eigen::MatrixXd::Identity(2 * R, 2 * R));
    cost = coefficients.transpose() * integral * coefficients;
  }
};

// Derivatives of order 1 .. R - 1 at one point, each of north, east, down and yaw.
using Free = Eigen::Matrix<double, Eigen::Dynamic, 4, 0, kLargestOrder - 1, 4>;

// The derivatives at all points that minimise the cost.
std::vector<Free> solve(const UnitSegment& unit, const std::vector<PositionYaw>& points,
                        const std::vector<double>& durations_s, const Free& at_start, const Free& at_end) {
  using Block =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kLargestOrder - 1, kLargestOrder - 1>;
  using Scale = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kLargestOrder - 1, 1>;
  const int R = unit.R;
  const int n = R - 1;
  const std::size_t last = points.size() - 1;
  std::vector<Free> derivatives(points.size(), Free::Zero(n, 4));
  derivatives.front() = at_start;
  derivatives.back() = at_end;
  if (last < 2) return derivatives;

  // The normal equations: diagonal blocks, blocks right of the diagonal, right-hand side. For a segment of
  // duration T the k-th derivative is scaled by T^k, and the cost by T^(1 - 2R).
  std::vector<Block> diagonal(points.size(), Block::Zero(n, n));
  std::vector<Block> next(points.size(), Block::Zero(n, n));
  std::vector<Free> right(points.size(), Free::Zero(n, 4));
  for (std::size_t i = 0; i < last; ++i) {
    const double T = durations_s[i];
    Scale scale(n);
    double power = 1.0;
    for (int k = 0; k < n; ++k) scale[k] = power *= T;
    double weight = 1.0 / T;
    for (int k = 1; k < R; ++k) weight /= T * T;
    const auto s = scale.asDiagonal();
    diagonal[i] += weight * (s * unit.cost.block(1, 1, n, n) * s);
    diagonal[i + 1] += weight * (s * unit.cost.block(R + 1, R + 1, n, n) * s);
    next[i] = weight * (s * unit.cost.block(1, R + 1, n, n) * s);
    // The positions of both ends enter with opposite signs: only their difference matters.
    const Eigen::RowVector4d difference = (points[i + 1] - points[i]).transpose();
    right[i] -= weight * (s * unit.cost.block(1, R, n, 1)) * difference;
    right[i + 1] -= weight * (s * unit.cost.block(R + 1, R, n, 1)) * difference;
  }
  right[1] -= next[0].transpose() * at_start;
  right[last - 1] -= next[last - 1] * at_end;

  // Block elimination downwards, then back.
  for (std::size_t k = 2; k < last; ++k) {
    const Block factor = diagonal[k - 1].ldlt().solve(next[k - 1]).transpose();
    diagonal[k] -= factor * next[k - 1];
    right[k] -= factor * right[k - 1];
  }
  for (std::size_t k = last - 1; k > 0; --k) {
    if (k + 1 < last) right[k] -= next[k] * derivatives[k + 1];
    derivatives[k] = diagonal[k].ldlt().solve(right[k]);
  }
  return derivatives;
}

PolynomialSegment segment_between(const UnitSegment& unit, const PositionYaw& from, const Free& at_from,
                                  const PositionYaw& to, const Free& at_to, double duration_s) {
  using Ends = Eigen::Matrix<double, Eigen::Dynamic, 4, 0, 2 * kLargestOrder, 4>;
  const int R = unit.R;
  // Relative to `from`, so that positions far from the origin do not lose precision.
  Ends ends(2 * R, 4);
  ends.row(0).setZero();
  ends.row(R) = (to - from).transpose();
  double power = 1.0;
  for (int k = 1; k < R; ++k) {
    power *= duration_s;
    ends.row(k) = power * at_from.row(k - 1);
    ends.row(R + k) = power * at_to.row(k - 1);
  }
  Ends coefficients = unit.coefficients * ends;
  coefficients.row(0) = from.transpose();
  PolynomialSegment segment;
  segment.duration_s = duration_s;
  const std::array<Polynomial*, 4> axes = {&segment.x, &segment.y, &segment.z, &segment.yaw};
  for (int axis = 0; axis < 4; ++axis) {
    double divisor = 1.0;
    for (int i = 0; i < 2 * R; ++i) {
      (*axes[static_cast<std::size_t>(axis)])[static_cast<std::size_t>(i)] = coefficients(i, axis) / divisor;
      divisor *= duration_s;
    }
  }
  return segment;
}

}  // namespace

std::vector<PolynomialSegment> spline(Smoothness smoothness, const std::vector<PositionYaw>& points,
                                      const std::vector<double>& durations_s,
                                      const PlaceDerivatives& at_start, const PlaceDerivatives& at_end) {
  static const UnitSegment least_jerk(3);
  static const UnitSegment least_snap(kLargestOrder);
  const UnitSegment& unit = smoothness == Smoothness::kMinimumSnap ? least_snap : least_jerk;
  const auto free_of = [&](const PlaceDerivatives& all) {
    return Free(all.leftCols(unit.R - 1).transpose());
  };
  const std::vector<Free> derivatives = solve(unit, points, durations_s, free_of(at_start), free_of(at_end));
  std::vector<PolynomialSegment> segments;
  segments.reserve(durations_s.size());
  for (std::size_t i = 0; i < durations_s.size(); ++i) {
    segments.push_back(
        segment_between(unit, points[i], derivatives[i], points[i + 1], derivatives[i + 1], durations_s[i]));
  }
  return segments;
}

}  // namespace swiftlet::control
