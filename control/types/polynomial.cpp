#include "swiftlet/control/types/polynomial.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::control {
namespace {

// x, y, z and yaw.
using Axes = Eigen::Array4d;

// Four polynomials and their first four derivatives at one t.
using Derivatives = std::array<Axes, 5>;

// Horner's scheme for the values and the derivatives at once; d[k] collects the k-th derivative over k!.
Derivatives horner(const PolynomialSegment& segment, std::size_t coefficients, double t) {
  Derivatives d;
  d.fill(Axes::Zero());
  for (std::size_t i = coefficients; i-- > 0;) {
    for (std::size_t k = 4; k > 0; --k) d[k] = d[k] * t + d[k - 1];
    d[0] = d[0] * t + Axes(segment.x[i], segment.y[i], segment.z[i], segment.yaw[i]);
  }
  return {d[0], d[1], 2.0 * d[2], 6.0 * d[3], 24.0 * d[4]};
}

// Number of coefficients without trailing ones that are zero on all axes: rest has one, most moves have six.
std::size_t coefficients(const PolynomialSegment& segment) {
  std::size_t count = kPolynomialCoefficients;
  const auto is_zero = [&](std::size_t i) {
    return segment.x[i] == 0.0 && segment.y[i] == 0.0 && segment.z[i] == 0.0 && segment.yaw[i] == 0.0;
  };
  while (count > 0 && is_zero(count - 1)) --count;
  return count;
}

// 10 s^3 - 15 s^4 + 6 s^5 from `from` to `to`, s = t / duration.
Polynomial minimum_jerk_axis(double from, double to, double duration_s) {
  const double step = to - from;
  const double w = 1.0 / duration_s;
  const double w3 = w * w * w;
  return {from, 0.0, 0.0, 10.0 * step * w3, -15.0 * step * w3 * w, 6.0 * step * w3 * w * w, 0.0, 0.0};
}

// The septic between position, velocity, acceleration and jerk at its two ends.
Polynomial septic(const std::array<double, 4>& from, const std::array<double, 4>& to, double duration_s) {
  const double t = duration_s;
  const double t2 = t * t;
  const double t3 = t2 * t;
  // The end minus the cubic extrapolation from the start, in units of s = t / duration.
  const double p = to[0] - (from[0] + t * from[1] + t2 / 2.0 * from[2] + t3 / 6.0 * from[3]);
  const double v = t * (to[1] - (from[1] + t * from[2] + t2 / 2.0 * from[3]));
  const double a = t2 * (to[2] - (from[2] + t * from[3]));
  const double j = t3 * (to[3] - from[3]);
  const double w4 = 1.0 / (t2 * t2);
  return {from[0],
          from[1],
          from[2] / 2.0,
          from[3] / 6.0,
          (35.0 * p - 15.0 * v + 2.5 * a - j / 6.0) * w4,
          (-84.0 * p + 39.0 * v - 7.0 * a + j / 2.0) * w4 / t,
          (70.0 * p - 34.0 * v + 6.5 * a - j / 2.0) * w4 / t2,
          (-20.0 * p + 10.0 * v - 2.0 * a + j / 6.0) * w4 / t3};
}

}  // namespace

Reference evaluate(const PolynomialSegment& segment, double t_s) {
  const double t = std::clamp(t_s, 0.0, segment.duration_s);
  const Derivatives d = horner(segment, coefficients(segment), t);
  Reference reference;
  reference.position_ned = d[0].head<3>();
  reference.velocity_ned = d[1].head<3>();
  reference.acceleration_ned = d[2].head<3>();
  reference.jerk_ned = d[3].head<3>();
  reference.snap_ned = d[4].head<3>();
  reference.yaw_rad = d[0][3];
  reference.yaw_rate = d[1][3];
  reference.yaw_acceleration = d[2][3];
  return reference;
}

PolynomialSegment stretched(const PolynomialSegment& segment, double factor) {
  PolynomialSegment out = segment;
  out.duration_s *= factor;
  for (Polynomial* const axis : {&out.x, &out.y, &out.z, &out.yaw}) {
    double divisor = 1.0;
    for (double& c : *axis) {
      c /= divisor;
      divisor *= factor;
    }
  }
  return out;
}

PolynomialSegment minimum_jerk(const Eigen::Vector3d& from_ned, double from_yaw,
                               const Eigen::Vector3d& to_ned, double to_yaw, double duration_s) {
  PolynomialSegment segment;
  segment.duration_s = duration_s;
  segment.x = minimum_jerk_axis(from_ned.x(), to_ned.x(), duration_s);
  segment.y = minimum_jerk_axis(from_ned.y(), to_ned.y(), duration_s);
  segment.z = minimum_jerk_axis(from_ned.z(), to_ned.z(), duration_s);
  segment.yaw = minimum_jerk_axis(from_yaw, to_yaw, duration_s);
  return segment;
}

Polynomial quintic_to_rest(double value, double first, double second, double to, double duration_s) {
  const double w = 1.0 / duration_s;
  const double w3 = w * w * w;
  const double d = to - value;
  const double v = first * duration_s;
  const double a = second * duration_s * duration_s;
  return {value,
          first,
          0.5 * second,
          (10.0 * d - 6.0 * v - 1.5 * a) * w3,
          (-15.0 * d + 8.0 * v + 1.5 * a) * w3 * w,
          (6.0 * d - 3.0 * v - 0.5 * a) * w3 * w * w,
          0.0,
          0.0};
}

PolynomialSegment join_to_rest(const Reference& from, const Eigen::Vector3d& to_ned, double to_yaw,
                               double duration_s) {
  const auto axis = [&](int i) {
    return quintic_to_rest(from.position_ned[i], from.velocity_ned[i], from.acceleration_ned[i], to_ned[i],
                           duration_s);
  };
  PolynomialSegment segment;
  segment.duration_s = duration_s;
  segment.x = axis(0);
  segment.y = axis(1);
  segment.z = axis(2);
  segment.yaw = quintic_to_rest(from.yaw_rad, from.yaw_rate, from.yaw_acceleration, to_yaw, duration_s);
  return segment;
}

PolynomialSegment join(const Reference& from, const Reference& to, double duration_s) {
  const auto ends = [](const Reference& r, int i) {
    return std::array<double, 4>{r.position_ned[i], r.velocity_ned[i], r.acceleration_ned[i], r.jerk_ned[i]};
  };
  const auto yaw = [](const Reference& r) {
    return std::array<double, 4>{r.yaw_rad, r.yaw_rate, r.yaw_acceleration, 0.0};
  };
  PolynomialSegment segment;
  segment.duration_s = duration_s;
  segment.x = septic(ends(from, 0), ends(to, 0), duration_s);
  segment.y = septic(ends(from, 1), ends(to, 1), duration_s);
  segment.z = septic(ends(from, 2), ends(to, 2), duration_s);
  segment.yaw = septic(yaw(from), yaw(to), duration_s);
  return segment;
}

double minimum_jerk_duration(double distance, double peak_speed, double peak_acceleration, double peak_jerk,
                             double min_duration_s) {
  return std::max({15.0 / 8.0 * distance / peak_speed,
                   std::sqrt(10.0 / std::sqrt(3.0) * distance / peak_acceleration),
                   std::cbrt(60.0 * distance / peak_jerk), min_duration_s});
}

double septic_duration(double distance, double peak_speed, double peak_acceleration, double peak_jerk,
                       double min_duration_s) {
  return std::max({35.0 / 16.0 * distance / peak_speed,
                   std::sqrt(84.0 / 25.0 * std::sqrt(5.0) * distance / peak_acceleration),
                   std::cbrt(105.0 / 2.0 * distance / peak_jerk), min_duration_s});
}

}  // namespace swiftlet::control
