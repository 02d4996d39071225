#include "swiftlet/record/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::record {
namespace {

template <std::size_t N>
void blend(const std::array<double, N>& a, const std::array<double, N>& b, double share,
           std::array<double, N>& out) {
  for (std::size_t i = 0; i < N; ++i) out[i] = a[i] + share * (b[i] - a[i]);
}

void blend_others(const TruthRow& a, const TruthRow& b, double share, TruthRow& out) {
  blend(a.rotor_speeds, b.rotor_speeds, share, out.rotor_speeds);
  out.supply_voltage_v += share * (b.supply_voltage_v - a.supply_voltage_v);
}
void blend_others(const EstimateRow&, const EstimateRow&, double, EstimateRow&) {}

template <class Row>
Row interpolated(const Row& a, const Row& b, std::int64_t stamp_ns) {
  const double h = math::seconds(b.stamp_ns - a.stamp_ns);
  const double s = math::seconds(stamp_ns - a.stamp_ns) / h;
  Row row = a;
  row.stamp_ns = stamp_ns;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    row.position_ned[axis] = (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s) * a.position_ned[axis] +
                             s * (1.0 - s) * (1.0 - s) * h * a.velocity_ned[axis] +
                             s * s * (3.0 - 2.0 * s) * b.position_ned[axis] -
                             s * s * (1.0 - s) * h * b.velocity_ned[axis];
  }
  blend(a.velocity_ned, b.velocity_ned, s, row.velocity_ned);
  blend(a.body_rates_frd, b.body_rates_frd, s, row.body_rates_frd);
  blend_others(a, b, s, row);
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

// The tracked poses, with velocities between their neighbours.
std::vector<TruthRow> captured_motion(const std::vector<plant::PoseSample>& poses) {
  std::vector<TruthRow> rows;
  for (const plant::PoseSample& pose : poses) {
    if (!pose.tracked) continue;
    const Eigen::Quaterniond& q = pose.q_ned_from_frd;
    TruthRow row;
    row.stamp_ns = pose.stamp_ns;
    std::copy_n(pose.position_ned.data(), 3, row.position_ned.begin());
    row.q_ned_from_frd = {q.w(), q.x(), q.y(), q.z()};
    rows.push_back(row);
  }
  for (std::size_t i = 0; rows.size() > 1 && i < rows.size(); ++i) {
    const TruthRow& before = rows[i == 0 ? 0 : i - 1];
    const TruthRow& after = rows[std::min(i + 1, rows.size() - 1)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rows[i].velocity_ned[axis] = (after.position_ned[axis] - before.position_ned[axis]) /
                                   math::seconds(after.stamp_ns - before.stamp_ns);
    }
  }
  return rows;
}

bool is_over(const MissionRow& row) {
  const auto state = static_cast<control::MissionState>(row.state);
  return state == control::MissionState::kCompleted || state == control::MissionState::kAborted;
}

// The rows of a mission from its start to its end, or to that of the record.
struct MissionRows {
  std::vector<MissionRow>::const_iterator first;
  std::vector<MissionRow>::const_iterator end;  // behind the row that says that it is over

  std::uint64_t id() const { return first->mission_id; }
  bool is_ended() const { return is_over(*(end - 1)); }
  // When its last item began, if that was the landing that ended it.
  std::optional<std::int64_t> landing_ns() const {
    if (!is_ended() || (end - 1)->reason != control::to_string(control::Reason::kLanded)) return std::nullopt;
    const auto begin = std::find_if(
        first, end, [&](const MissionRow& row) { return row.item_index == (end - 1)->item_index; });
    return begin->stamp_ns;
  }
};

std::vector<MissionRows> missions_of(const std::vector<MissionRow>& rows) {
  std::vector<MissionRows> missions;
  const auto under_way = [](const MissionRow& row) {
    return control::is_under_way(static_cast<control::MissionState>(row.state));
  };
  for (auto at = std::find_if(rows.begin(), rows.end(), under_way); at != rows.end();
       at = std::find_if(at, rows.end(), under_way)) {
    const auto first = at;
    while (at != rows.end() && at->mission_id == first->mission_id && !is_over(*at)) ++at;
    if (at != rows.end() && at->mission_id == first->mission_id) ++at;
    missions.push_back({first, at});
  }
  return missions;
}

using References = std::vector<ReferenceRow>;

bool is_in(const ReferenceRow& row, control::Mode mode) { return row.mode == static_cast<int>(mode); }
bool is_tracked(const ReferenceRow& row) {
  return row.mode >= static_cast<int>(control::Mode::kTakingOff) &&
         row.mode < static_cast<int>(control::Mode::kLanding);
}

std::optional<Window> mission_window(const MissionRows& mission, const References& reference) {
  const auto in_mission = [](const ReferenceRow& row) { return is_in(row, control::Mode::kMission); };
  const auto first = std::find_if(reference.begin(), reference.end(), in_mission);
  const std::int64_t end_ns = (mission.end - 1)->stamp_ns;
  // Flown after it: another mission, whose status was lost.
  if (first == reference.end() || (mission.is_ended() && first->stamp_ns > end_ns)) return std::nullopt;
  if (const auto landing_ns = mission.landing_ns()) return Window{first->stamp_ns, *landing_ns};
  auto last = reference.end() - 1;
  const std::int64_t over_ns = mission.is_ended() ? end_ns : std::numeric_limits<std::int64_t>::max();
  while (last != first && (!in_mission(*last) || last->stamp_ns > over_ns)) --last;
  return Window{first->stamp_ns, last->stamp_ns + 1};
}

std::optional<Window> flying_window(const References& reference) {
  const auto first = std::find_if(reference.begin(), reference.end(), is_tracked);
  if (first == reference.end()) return std::nullopt;
  const auto end = std::find_if_not(first, reference.end(), is_tracked);
  return Window{first->stamp_ns, (end - 1)->stamp_ns + 1};
}

}  // namespace

template <class Row>
std::optional<Row> motion_at(const std::vector<Row>& rows, typename std::vector<Row>::const_iterator after,
                             std::int64_t stamp_ns) {
  if (after == rows.end()) return std::nullopt;
  if (after->stamp_ns == stamp_ns) return *after;
  if (after == rows.begin()) return std::nullopt;
  const Row& before = *(after - 1);
  if (math::seconds(after->stamp_ns - before.stamp_ns) > kLongestInterpolationS) return std::nullopt;
  return interpolated(before, *after, stamp_ns);
}

template <class Row>
TrackingErrors tracking_errors(const std::vector<Row>& flown, const References& reference, Window window) {
  TrackingErrors errors;
  std::array<double, 3> sum_of_squares{};
  std::int64_t last_ns = window.from_ns;

  auto after = flown.begin();
  for (const ReferenceRow& row : reference) {
    while (after != flown.end() && after->stamp_ns < row.stamp_ns) ++after;
    if (row.stamp_ns < window.from_ns || row.stamp_ns >= window.to_ns) continue;
    const std::optional<Row> motion = motion_at(flown, after, row.stamp_ns);
    if (!motion) continue;
    double distance_squared = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double error = motion->position_ned[axis] - row.position_ned[axis];
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

#define SWIFTLET_FOR_ROWS(Row)                                                                     \
  template std::optional<Row> motion_at(const std::vector<Row>&, std::vector<Row>::const_iterator, \
                                        std::int64_t);                                             \
  template TrackingErrors tracking_errors(const std::vector<Row>&, const References&, Window);
SWIFTLET_FOR_ROWS(TruthRow)
SWIFTLET_FOR_ROWS(EstimateRow)
#undef SWIFTLET_FOR_ROWS

const char* to_string(Against against) {
  switch (against) {
    case Against::kGroundTruth:
      return "ground truth";
    case Against::kMotionCapture:
      return "motion capture";
    case Against::kEstimate:
      return "estimate";
  }
  return "unknown";
}

TrackingErrors tracking_errors(const Flight& flight, Window window) {
  if (!flight.truth.empty()) return tracking_errors(flight.truth, flight.reference, window);
  const std::vector<TruthRow> captured = captured_motion(flight.poses);
  TrackingErrors errors = captured.empty() ? tracking_errors(flight.estimate, flight.reference, window)
                                           : tracking_errors(captured, flight.reference, window);
  errors.against = captured.empty() ? Against::kEstimate : Against::kMotionCapture;
  return errors;
}

bool enough_samples(const TrackingErrors& errors, Window window, double rate_hz) {
  const double expected = window.duration_s() * rate_hz;
  return errors.matched > 0 && static_cast<double>(errors.matched) >= kLeastMatchedFraction * expected &&
         errors.longest_gap_s <= kLongestGapS;
}

Evaluation evaluate(const Flight& flight) {
  Evaluation result;
  const std::vector<MissionRows> missions = missions_of(flight.mission);
  if (missions.empty()) {
    result.window = flying_window(flight.reference);
    if (result.window) result.duration_s = result.window->duration_s();
  } else {
    const MissionRows& mission = missions.front();
    const MissionRow& last = *(mission.end - 1);
    result.mission_id = mission.id();
    result.completed = static_cast<control::MissionState>(last.state) == control::MissionState::kCompleted;
    if (!result.completed) result.reason = last.reason;
    result.window = mission_window(mission, flight.reference);
    const std::int64_t end_ns = mission.is_ended()         ? last.stamp_ns
                                : flight.reference.empty() ? 0
                                                           : flight.reference.back().stamp_ns;
    if (result.window) result.duration_s = math::seconds(end_ns - result.window->from_ns);
  }
  result.errors = tracking_errors(flight, result.window.value_or(Window{}));
  return result;
}

std::vector<Window> landing_items(const Flight& flight) {
  std::vector<Window> landings;
  for (const MissionRows& mission : missions_of(flight.mission)) {
    if (const auto from_ns = mission.landing_ns())
      landings.push_back({*from_ns, (mission.end - 1)->stamp_ns + 1});
  }
  return landings;
}

}  // namespace swiftlet::record
