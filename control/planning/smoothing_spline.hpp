// The smoothest spline that passes all samples within their tolerances. It minimises the integral of the squared
// fifth derivative, and so leaves out the rounding of the samples: a spline through them reproduces it, and
// a micrometre at 100 Hz is a snap of 100 m/s^4.
//
// Splines of degree 7 in B-spline form (de Boor, "A Practical Guide to Splines", 1978), on knots that are refined where
// the samples need it.
#pragma once

#include <cstddef>
#include <vector>

#include "swiftlet/control/planning/spline.hpp"
#include "swiftlet/control/types/polynomial.hpp"

namespace swiftlet::control {

// The place, or one of its first two derivatives, at a time.
struct SplineSample {
  double time_s = 0.0;
  int derivative = 0;     // 0: m, rad; 1: m/s, rad/s; 2: m/s^2, rad/s^2
  PositionYaw value;      // NED
  PositionYaw tolerance;  // > 0; infinite: this axis has no sample
};

struct SmoothedPath {
  std::vector<PolynomialSegment> segments;  // from the first to the last sample; snap is continuous
  // Greatest deviation of a sample over its tolerance: above 1, the samples need more segments.
  double tolerance_use = 0.0;
};

// samples: two or more in the order of time, the first and the last with derivative 0. The path begins at rest: velocity
// and acceleration are zero; and ends so if rests_at_end. max_segments: kMinSmoothedSegments or more.
SmoothedPath smoothing_spline(const std::vector<SplineSample>& samples, bool rests_at_end,
                              std::size_t max_segments);
constexpr std::size_t kMinSmoothedSegments = 8;
constexpr double kSmoothingPrecision =
    1.001;  // of tolerance_use: up to here the samples are within their tolerances

}  // namespace swiftlet::control
