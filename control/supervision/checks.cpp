#include "control/supervision/checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace swiftlet::control {
namespace {

constexpr double kJoin_m = 1e-3;    // step in position between segments that is let through
constexpr double kJoin_m_s = 1e-2;  // and in velocity
constexpr double kSampleInterval_s = 0.05;

bool finite(const Polynomial& p) {
  return std::all_of(p.begin(), p.end(), [](double c) { return std::isfinite(c); });
}

Outcome check_sample(std::size_t segment, const Reference& r, const Limits& limits) {
  char what[48];
  std::snprintf(what, sizeof what, "segment %zu", segment + 1);
  Outcome outcome = check_position(what, r.position_ned, limits);
  if (!outcome.accepted) return outcome;
  if (r.velocity_ned.norm() > limits.max_speed) {
    return refuse("%s reaches %.2f m/s, the limit is %.2f m/s", what, r.velocity_ned.norm(),
                  limits.max_speed);
  }
  if (r.acceleration_ned.norm() > limits.max_acceleration) {
    return refuse("%s reaches %.2f m/s^2, the limit is %.2f m/s^2", what, r.acceleration_ned.norm(),
                  limits.max_acceleration);
  }
  return accept();
}

}  // namespace

Outcome accept() {
  Outcome outcome;
  outcome.accepted = true;
  return outcome;
}

Outcome refuse(const char* format, ...) {
  Outcome outcome;
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(outcome.reason, sizeof outcome.reason, format, arguments);
  va_end(arguments);
  return outcome;
}

Outcome check_position(const char* what, const Eigen::Vector3d& position_ned, const Limits& limits) {
  constexpr char kAxis[] = "xyz";
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(position_ned[i])) return refuse("%s: %c is not a finite number", what, kAxis[i]);
    if (position_ned[i] < limits.fence_min_ned[i] || position_ned[i] > limits.fence_max_ned[i]) {
      return refuse("%s: %c is %.3f m, outside the fence of %.3f to %.3f m", what, kAxis[i], position_ned[i],
                    limits.fence_min_ned[i], limits.fence_max_ned[i]);
    }
  }
  return accept();
}

Outcome check_speed(const char* what, double speed, const Limits& limits) {
  if (std::isfinite(speed) && speed > 0.0 && speed <= limits.max_speed) return accept();
  return refuse("%s: speed is %.3f m/s, must be above 0 and at most %.3f m/s", what, speed, limits.max_speed);
}

Outcome check(const Mission& mission, const Limits& limits) {
  const std::size_t count = mission.items.size();
  if (count == 0) return refuse("the mission has no items");
  if (count > kMaxMissionItems)
    return refuse("the mission has %zu items, at most %d fit", count, kMaxMissionItems);
  for (std::size_t i = 0; i < count; ++i) {
    const MissionItem& item = mission.items[i];
    char what[32];
    std::snprintf(what, sizeof what, "item %zu", i + 1);
    if (item.kind == MissionItemKind::kTakeoff && i != 0)
      return refuse("%s: a takeoff can only be the first item", what);
    if (item.kind == MissionItemKind::kLand && i + 1 != count)
      return refuse("%s: a landing can only be the last item", what);
    Outcome outcome = check_speed(what, item.speed, limits);
    if (!outcome.accepted) return outcome;
    if (!std::isfinite(item.hold_s) || item.hold_s < 0.0)
      return refuse("%s: hold is %.3f s, must be 0 or more", what, item.hold_s);
    if (item.kind == MissionItemKind::kLand) continue;
    Eigen::Vector3d position = item.position_ned;
    if (item.kind == MissionItemKind::kTakeoff)
      position.head<2>() = 0.5 * (limits.fence_min_ned + limits.fence_max_ned).head<2>();
    outcome = check_position(what, position, limits);
    if (!outcome.accepted) return outcome;
    if (!item.yaw_free && !std::isfinite(item.yaw_rad)) return refuse("%s: yaw is not a finite number", what);
  }
  return accept();
}

Outcome check(const Trajectory& trajectory, const Limits& limits) {
  const std::size_t count = trajectory.segments.size();
  if (count == 0) return refuse("the trajectory has no segments");
  if (count > kMaxTrajectorySegments) {
    return refuse("the trajectory has %zu segments, at most %d fit", count, kMaxTrajectorySegments);
  }
  Reference end;  // of the segment before
  for (std::size_t i = 0; i < count; ++i) {
    const PolynomialSegment& segment = trajectory.segments[i];
    if (!std::isfinite(segment.duration_s) || segment.duration_s <= 0.0 || segment.duration_s > 3600.0) {
      return refuse("segment %zu: duration is %.3f s, must be above 0 and at most 3600 s", i + 1,
                    segment.duration_s);
    }
    if (!finite(segment.x) || !finite(segment.y) || !finite(segment.z) || !finite(segment.yaw)) {
      return refuse("segment %zu: a coefficient is not a finite number", i + 1);
    }
    const Reference start = evaluate(segment, 0.0);
    if (i == 0 && start.velocity_ned.norm() > kJoin_m_s) {
      return refuse("the trajectory starts at %.2f m/s, must start at rest", start.velocity_ned.norm());
    }
    if (i > 0 && ((start.position_ned - end.position_ned).norm() > kJoin_m ||
                  (start.velocity_ned - end.velocity_ned).norm() > kJoin_m_s)) {
      return refuse("segment %zu does not begin where the one before ends: %.3f m and %.3f m/s apart", i + 1,
                    (start.position_ned - end.position_ned).norm(),
                    (start.velocity_ned - end.velocity_ned).norm());
    }
    const int samples = static_cast<int>(std::ceil(segment.duration_s / kSampleInterval_s));
    for (int k = 0; k <= samples; ++k) {
      const Outcome outcome = check_sample(i, evaluate(segment, segment.duration_s * k / samples), limits);
      if (!outcome.accepted) return outcome;
    }
    end = evaluate(segment, segment.duration_s);
  }
  return accept();
}

}  // namespace swiftlet::control
