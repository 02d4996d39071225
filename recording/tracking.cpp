#include "swiftlet/recording/tracking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace swiftlet::ground {
namespace {

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

TrackingErrors tracking_errors(const Track<TruthRow>& truth, const Track<ReferenceRow>& reference,
                               Window window) {
  TrackingErrors errors;
  std::array<double, 3> sum_of_squares{};
  std::int64_t last_ns = window.from_ns;

  const TruthRow* flown = truth.begin();
  const ReferenceRow* reference_row = reference.begin();
  const TruthRow* const flown_end = truth.end();
  const ReferenceRow* const reference_end = reference.end();
  while (flown != flown_end && reference_row != reference_end) {
    if (flown->stamp_ns < reference_row->stamp_ns) {
      ++flown;
      continue;
    }
    if (reference_row->stamp_ns < flown->stamp_ns) {
      ++reference_row;
      continue;
    }
    const std::int64_t stamp_ns = flown->stamp_ns;
    if (stamp_ns >= window.from_ns && stamp_ns < window.to_ns) {
      double distance_squared = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double error = flown->position_ned[axis] - reference_row->position_ned[axis];
        sum_of_squares[axis] += error * error;
        errors.peak_m[axis] = std::max(errors.peak_m[axis], std::abs(error));
        distance_squared += error * error;
      }
      errors.peak_3d_m = std::max(errors.peak_3d_m, std::sqrt(distance_squared));
      errors.longest_gap_s = std::max(errors.longest_gap_s, seconds(stamp_ns - last_ns));
      last_ns = stamp_ns;
      ++errors.matched;
    }
    ++flown;
    ++reference_row;
  }
  errors.longest_gap_s = std::max(errors.longest_gap_s, seconds(window.to_ns - last_ns));

  if (errors.matched == 0) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    errors.rms_m.fill(kNone);
    errors.peak_m.fill(kNone);
    errors.rms_3d_m = errors.peak_3d_m = kNone;
    return errors;
  }
  const double count = static_cast<double>(errors.matched);
  for (std::size_t axis = 0; axis < 3; ++axis) errors.rms_m[axis] = std::sqrt(sum_of_squares[axis] / count);
  errors.rms_3d_m = std::sqrt((sum_of_squares[0] + sum_of_squares[1] + sum_of_squares[2]) / count);
  return errors;
}

bool enough_samples(const TrackingErrors& errors, Window window, double rate_hz) {
  const double expected = window.duration_s() * rate_hz;
  return errors.matched > 0 && static_cast<double>(errors.matched) >= kLeastMatchedFraction * expected &&
         errors.longest_gap_s <= kLongestGapS;
}

}  // namespace swiftlet::ground
