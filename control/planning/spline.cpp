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

// A segment of duration 1, R = 3 for jerk and 4 for snap. Coefficients and cost are functions of the ends'
// derivatives of order 0 .. R - 1, those at the start first.
template <int R>
struct UnitSegment {
  using Matrix = Eigen::Matrix<double, 2 * R, 2 * R>;
  Matrix coefficients;  // from the ends' derivatives
  Matrix cost;          // d' cost d is the integral of the squared R-th derivative

  UnitSegment() {
    Matrix ends = Matrix::Zero();  // derivatives from coefficients
    Matrix integral = Matrix::Zero();
    for (int k = 0; k < R; ++k) {
      ends(k, k) = falling(k, k);
      for (int i = k; i < 2 * R; ++i) ends(R + k, i) = falling(i, k);
    }
    for (int i = R; i < 2 * R; ++i) {
      for (int j = R; j < 2 * R; ++j) integral(i, j) = falling(i, R) * falling(j, R) / (i + j - 2 * R + 1);
    }
    coefficients = math::solve(Eigen::MatrixXd(ends), Matrix::Identity());
    cost = coefficients.transpose() * integral * coefficients;
  }
};

// Derivatives of order 1 .. R - 1 at one point, each of north, east, down and yaw.
template <int R>
using Free = Eigen::Matrix<double, R - 1, 4>;

template <int R>
Free<R> free_of(const PlaceDerivatives& derivatives) {
  return derivatives.leftCols<R - 1>().transpose();
}

// The derivatives at all points that minimise the cost.
template <int R>
std::vector<Free<R>> solve(const UnitSegment<R>& unit, const std::vector<PositionYaw>& points,
                           const std::vector<double>& durations_s, const Free<R>& at_start,
                           const Free<R>& at_end) {
  using Block = Eigen::Matrix<double, R - 1, R - 1>;
  const std::size_t last = points.size() - 1;
  std::vector<Free<R>> derivatives(points.size(), Free<R>::Zero());
  derivatives.front() = at_start;
  derivatives.back() = at_end;
  if (last < 2) return derivatives;

  // The normal equations: diagonal blocks, blocks right of the diagonal, right-hand side. For a segment of
  // duration T the k-th derivative is scaled by T^k, and the cost by T^(1 - 2R).
  std::vector<Block> diagonal(points.size(), Block::Zero());
  std::vector<Block> next(points.size(), Block::Zero());
  std::vector<Free<R>> right(points.size(), Free<R>::Zero());
  for (std::size_t i = 0; i < last; ++i) {
    const double T = durations_s[i];
    Eigen::Matrix<double, R - 1, 1> scale;
    double power = 1.0;
    for (int k = 0; k < R - 1; ++k) scale[k] = power *= T;
    double weight = 1.0 / T;
    for (int k = 1; k < R; ++k) weight /= T * T;
    const auto s = scale.asDiagonal();
    diagonal[i] += weight * (s * unit.cost.template block<R - 1, R - 1>(1, 1) * s);
    diagonal[i + 1] += weight * (s * unit.cost.template block<R - 1, R - 1>(R + 1, R + 1) * s);
    next[i] = weight * (s * unit.cost.template block<R - 1, R - 1>(1, R + 1) * s);
    // The positions of both ends enter with opposite signs: only their difference matters.
    const Eigen::RowVector4d difference = (points[i + 1] - points[i]).transpose();
    right[i] -= weight * (s * unit.cost.template block<R - 1, 1>(1, R)) * difference;
    right[i + 1] -= weight * (s * unit.cost.template block<R - 1, 1>(R + 1, R)) * difference;
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

template <int R>
PolynomialSegment segment_between(const UnitSegment<R>& unit, const PositionYaw& from, const Free<R>& at_from,
                                  const PositionYaw& to, const Free<R>& at_to, double duration_s) {
  // Relative to `from`, so that positions far from the origin do not lose precision.
  Eigen::Matrix<double, 2 * R, 4> ends;
  ends.row(0).setZero();
  ends.row(R) = (to - from).transpose();
  double power = 1.0;
  for (int k = 1; k < R; ++k) {
    power *= duration_s;
    ends.row(k) = power * at_from.row(k - 1);
    ends.row(R + k) = power * at_to.row(k - 1);
  }
  Eigen::Matrix<double, 2 * R, 4> coefficients = unit.coefficients * ends;
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

template <int R>
std::vector<PolynomialSegment> least(const std::vector<PositionYaw>& points,
                                     const std::vector<double>& durations_s, const PlaceDerivatives& at_start,
                                     const PlaceDerivatives& at_end) {
  static const UnitSegment<R> unit;
  const std::vector<Free<R>> derivatives =
      solve<R>(unit, points, durations_s, free_of<R>(at_start), free_of<R>(at_end));
  std::vector<PolynomialSegment> segments;
  segments.reserve(durations_s.size());
  for (std::size_t i = 0; i < durations_s.size(); ++i) {
    segments.push_back(segment_between<R>(unit, points[i], derivatives[i], points[i + 1], derivatives[i + 1],
                                          durations_s[i]));
  }
  return segments;
}

}  // namespace

std::vector<PolynomialSegment> spline(Smoothness smoothness, const std::vector<PositionYaw>& points,
                                      const std::vector<double>& durations_s,
                                      const PlaceDerivatives& at_start, const PlaceDerivatives& at_end) {
  return smoothness == Smoothness::kMinimumSnap ? least<4>(points, durations_s, at_start, at_end)
                                                : least<3>(points, durations_s, at_start, at_end);
}

}  // namespace swiftlet::control
