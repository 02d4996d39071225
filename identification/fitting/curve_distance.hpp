// Orthogonal distance regression: distance of a measured point from a curve y = f(x; p) if both readings are
// noisy. Plain least squares assumes an exact x, so that noise in x reduces the slope of the fitted curve.
#pragma once

#include <cmath>
#include <cstddef>

#include <Eigen/Core>

namespace swiftlet::identification {

// Value and slope of f at a point.
struct CurveValue {
  double y = 0.0;
  double slope = 0.0;  // df/dx
};

// Minimises ((y_read - f(x)) / y_spread)^2 + ((x_read - x) / x_spread)^2 over the true x. curve(x) returns a
// CurveValue. distance is the square root of the minimum with the sign of y_read - f, and x its location. The
// derivative of distance by a parameter p of the curve is -df/dp(x) / spread.
struct CurveDistance {
  double distance = 0.0;
  double x = 0.0;
  double spread = 0.0;
};

template <typename Curve>
CurveDistance curve_distance(const Curve& curve, double x_read, double y_read, double x_spread,
                             double y_spread) {
  constexpr int kMostSteps = 12;  // two are enough if the slope hardly changes over the spread of x
  constexpr double kEnough = 1e-10;
  CurveDistance out;
  out.x = x_read;
  for (int step = 0; step < kMostSteps; ++step) {
    const CurveValue at = curve(out.x);
    const double tangent_off = y_read - at.y - at.slope * (x_read - out.x);
    const double variance = y_spread * y_spread + at.slope * at.slope * x_spread * x_spread;
    out.spread = std::sqrt(variance);
    out.distance = tangent_off / out.spread;
    const double next = x_read + x_spread * x_spread * at.slope * tangent_off / variance;
    const double moved = std::abs(next - out.x);
    out.x = next;
    if (moved <= kEnough * x_spread) break;
  }
  return out;
}

}  // namespace swiftlet::identification
