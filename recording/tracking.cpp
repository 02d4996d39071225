#include "swiftlet/recording/tracking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "swiftlet/math/time.hpp"

namespace swiftlet::ground {
namespace {

template <std::size_t N>
void blend(const std::array<double, N>& a, const std::array<double, N>& b, double share,
           std::array<double, N>& out) {
  for (std::size_t i = 0; i < N; ++i) out[i] = a[i] + share * (b[i] - a[i]);
}

// Between two rows.
TruthRow interpolated(const TruthRow& a, const TruthRow& b, std::int64_t stamp_ns) {
  const double h = math::seconds(b.stamp_ns - a.stamp_ns);
  const double s = math::seconds(stamp_ns - a.stamp_ns) / h;
  TruthRow row = a;
  row.stamp_ns = stamp_ns;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    row.position_ned[axis] = (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s) * a.position_ned[axis] +
                             s * (1.0 - s) * (1.0 - s) * h * a.velocity_ned[axis] +
                             s * s * (3.0 - 2.0 * s) * b.position_ned[axis] -
                             s * s * (1.0 - s) * h * b.velocity_ned[axis];
  }
  blend(a.velocity_ned, b.velocity_ned, s, row.velocity_ned);
  blend(a.body_rates_frd, b.body_rates_frd, s, row.body_rates_frd);
  blend(a.rotor_speeds, b.rotor_speeds, s, row.rotor_speeds);
  row.supply_voltage_v += s * (b.supply_voltage_v - a.supply_voltage_v);
  const std::array<double, 4>& qa = a.q_ned_from_frd;
  std::array<double, 4> qb = b.q_ned_from_frd;
  if (std::inner_product(qa.begin(), qa.end(), qb.begin(), 0.0) < 0.0)
    for (double& component : qb) component = -component;
  blend(qa, qb, s, row.q_ned_from_frd);
  std::array<double, 4>& q = row.q_ned_from_frd;
  const double norm = std::sqrt(std::inner_product(q.begin(), q.end(), q.begin(), 0.0));
  for (double& component : q) component /= norm;
  return row;
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

std::optional<TruthRow> truth_at(const Track<TruthRow>& truth, const TruthRow* after, std::int64_t stamp_ns,
                                 TruthSource source) {
  if (after == truth.end()) return std::nullopt;
  if (after->stamp_ns == stamp_ns) return *after;
  if (source == TruthSource::kEqualStamps || after == truth.begin()) return std::nullopt;
  const TruthRow& before = *(after - 1);
  if (math::seconds(after->stamp_ns - before.stamp_ns) > kLongestInterpolationS) return std::nullopt;
  return interpolated(before, *after, stamp_ns);
}

double newest_error_m(const Track<TruthRow>& truth, const Track<ReferenceRow>& reference) {
  constexpr std::size_t kLookBack = 64;
  const TruthRow* const end = truth.end();  // rows come while this looks for one
  const TruthRow* const begin = end - std::min(static_cast<std::size_t>(end - truth.begin()), kLookBack);
  const std::size_t references = reference.size();
  for (std::size_t i = 0; i < std::min(references, kLookBack); ++i) {
    const ReferenceRow& row = reference[references - 1 - i];
    const TruthRow* const after =
        std::lower_bound(begin, end, row.stamp_ns,
                         [](const TruthRow& at, std::int64_t stamp_ns) { return at.stamp_ns < stamp_ns; });
    if (after == end) continue;
    const auto flown = truth_at(truth, after, row.stamp_ns, TruthSource::kInterpolated);
    if (flown) return distance(flown->position_ned, row.position_ned);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

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
    const std::optional<TruthRow> flown = truth_at(truth, after, row.stamp_ns, source);
    if (!flown) continue;
    double distance_squared = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double error = flown->position_ned[axis] - row.position_ned[axis];
      sum_of_squares[axis] += error * error;
      errors.peak_m[axis] = std::max(errors.peak_m[axis], std::abs(error));
      distance_squared += error * error;
    }
    errors.peak_3d_m = std::max(errors.peak_3d_m, std::sqrt(distance_squared));
    errors.longest_gap_s = std::max(errors.longest_gap_s, math::seconds(row.stamp_ns - last_ns));
    last_ns = row.stamp_ns;
    ++errors.matched;
  }
  errors.longest_gap_s = std::max(errors.longest_gap_s, math::seconds(window.to_ns - last_ns));

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
