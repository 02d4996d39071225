#include "swiftlet/recording/tracking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace swiftlet::ground {
namespace {

using Position = std::array<double, 3>;

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

// The cubic Hermite polynomial between two rows.
Position interpolated(const TruthRow& a, const TruthRow& b, std::int64_t stamp_ns) {
  const double h = seconds(b.stamp_ns - a.stamp_ns);
  const double s = seconds(stamp_ns - a.stamp_ns) / h;
  Position position;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    position[axis] = (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s) * a.position_ned[axis] +
                     s * (1.0 - s) * (1.0 - s) * h * a.velocity_ned[axis] +
                     s * s * (3.0 - 2.0 * s) * b.position_ned[axis] -
                     s * s * (1.0 - s) * h * b.velocity_ned[axis];
  }
  return position;
}

// The true position; nullopt if it is not known at this stamp. after: the first row that is not older.
std::optional<Position> position_at(const Track<TruthRow>& truth, const TruthRow* after,
                                    std::int64_t stamp_ns, TruthSource source) {
  if (after == truth.end()) return std::nullopt;
  if (after->stamp_ns == stamp_ns) return after->position_ned;
  if (source == TruthSource::kEqualStamps || after == truth.begin()) return std::nullopt;
  const TruthRow& before = *(after - 1);
  if (seconds(after->stamp_ns - before.stamp_ns) > kLongestInterpolationS) return std::nullopt;
  return interpolated(before, *after, stamp_ns);
}

}  // namespace

TrackingErrors tracking_errors(const Track<TruthRow>& truth, const Track<ReferenceRow>& reference,
                               Window window, TruthSource source) {
  TrackingErrors errors;
  std::array<double, 3> sum_of_squares{};
  std::int64_t last_ns = window.from_ns;

  const TruthRow* after = truth.begin();
  for (const ReferenceRow& row : reference) {
    while (after != truth.end() && after->stamp_ns < row.stamp_ns) ++after;
    if (row.stamp_ns < window.from_ns || row.stamp_ns >= window.to_ns) continue;
    if (errors.matched > 0 && row.stamp_ns == last_ns) continue;  // lockstep repeats samples
    const std::optional<Position> flown = position_at(truth, after, row.stamp_ns, source);
    if (!flown) continue;
    double distance_squared = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double error = (*flown)[axis] - row.position_ned[axis];
      sum_of_squares[axis] += error * error;
      errors.peak_m[axis] = std::max(errors.peak_m[axis], std::abs(error));
      distance_squared += error * error;
    }
    errors.peak_3d_m = std::max(errors.peak_3d_m, std::sqrt(distance_squared));
    errors.longest_gap_s = std::max(errors.longest_gap_s, seconds(row.stamp_ns - last_ns));
    last_ns = row.stamp_ns;
    ++errors.matched;
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
