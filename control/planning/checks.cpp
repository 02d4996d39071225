#include "swiftlet/control/planning/checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "swiftlet/control/planning/bernstein.hpp"
#include "swiftlet/control/planning/checks_in_frame.hpp"

namespace swiftlet::control {
namespace {

constexpr double kLongestSegment_s = 3600.0;
constexpr double kPlaceTolerance_m = 1e-9;  // rounding of sums of coefficients
constexpr double kPlacePrecision_m = 1e-6;  // of extrema

bool finite(const Polynomial& p) {
  return std::all_of(p.begin(), p.end(), [](double c) { return std::isfinite(c); });
}

// An axis of NED in the frame of a reason: its name, and -1 if it points the other way.
struct NamedAxis {
  char name;
  double sign;
};

NamedAxis axis_in(Frame frame, int ned_axis) {
  if (frame == Frame::kNed) return {"xyz"[ned_axis], 1.0};
  if (frame == Frame::kEnu) return {"yxz"[ned_axis], ned_axis == 2 ? -1.0 : 1.0};
  return {"xyz"[ned_axis], ned_axis == 0 ? 1.0 : -1.0};
}

// low, high: of the fence, in NED as what was reached.
Outcome outside_fence(InFrame named, int ned_axis, double reached, double low, double high) {
  const NamedAxis axis = axis_in(named.frame, ned_axis);
  const double ends[] = {axis.sign * low + 0.0, axis.sign * high + 0.0};  // no -0.000
  return refuse("%s: %c is %.3f m, outside the fence of %.3f to %.3f m", named.what, axis.name,
                axis.sign * reached, std::min(ends[0], ends[1]), std::max(ends[0], ends[1]));
}

Outcome check_inside_fence(InFrame named, const Eigen::Vector3d& position_ned, const Limits& limits) {
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(position_ned[i]))
      return refuse("%s: %c is not a finite number", named.what, axis_in(named.frame, i).name);
    if (position_ned[i] < limits.fence_min_ned[i] || position_ned[i] > limits.fence_max_ned[i])
      return outside_fence(named, i, position_ned[i], limits.fence_min_ned[i], limits.fence_max_ned[i]);
  }
  return accept();
}

Outcome check_axis(InFrame named, int ned_axis, const Polynomial& polynomial, double duration_s,
                   const Limits& limits) {
  const double low = limits.fence_min_ned[ned_axis];
  const double high = ned_axis == 2 ? lowest_z_ned(limits) : limits.fence_max_ned[ned_axis];
  const Bernstein position = bernstein(polynomial, duration_s);
  if (position.least() >= low - kPlaceTolerance_m && position.greatest() <= high + kPlaceTolerance_m)
    return accept();
  const double most = maximum(position, kPlacePrecision_m).value;
  if (ned_axis == 2) {
    const Outcome height = check_height(named, most, limits);
    if (!height.accepted) return height;
  }
  for (const double reached : {minimum(position, kPlacePrecision_m).value, most}) {
    if (reached >= low - kPlaceTolerance_m && reached <= high + kPlaceTolerance_m) continue;
    return outside_fence(named, ned_axis, reached, low, high);
  }
  return accept();
}

Outcome check_length(const char* what, const PolynomialSegment& segment, int derivative, double limit,
                     const char* unit) {
  const auto axis = [&](const Polynomial& p) { return bernstein(p, segment.duration_s, derivative); };
  const Bernstein square = squared_length(axis(segment.x), axis(segment.y), axis(segment.z));
  const double highest = (1.0 + kExtremumPrecision) * limit * limit;
  if (square.greatest() <= highest) return accept();
  const double reached = maximum(square, kExtremumPrecision * limit * limit).value;
  if (reached <= highest) return accept();
  return refuse("%s reaches %.2f %s, the limit is %.2f %s", what, std::sqrt(reached), unit, limit, unit);
}

Outcome check_segments(const char* of, const PolynomialSegment* segments, std::size_t count, bool yaw_free,
                       const Limits& limits) {
  for (std::size_t i = 0; i < count; ++i) {
    char what[64];
    std::snprintf(what, sizeof what, "%ssegment %zu", of, i + 1);
    Outcome outcome = check_segment(what, segments[i], limits);
    if (!outcome.accepted) return outcome;
    outcome = i == 0 ? check_start("the trajectory", segments[i], yaw_free)
                     : check_joint(what, segments[i - 1], segments[i]);
    if (!outcome.accepted) return outcome;
  }
  return check_end("the trajectory", segments[count - 1], yaw_free);
}

Outcome check_motion(InFrame named, const PolynomialSegment& segment, const Limits& limits) {
  const Polynomial* const axes[] = {&segment.x, &segment.y, &segment.z};
  for (int i = 0; i < 3; ++i) {
    const Outcome outcome = check_axis(named, i, *axes[i], segment.duration_s, limits);
    if (!outcome.accepted) return outcome;
  }
  const Outcome outcome = check_length(named.what, segment, 1, limits.max_speed, "m/s");
  if (!outcome.accepted) return outcome;
  return check_length(named.what, segment, 2, limits.max_acceleration, "m/s^2");
}

// verb: "start" or "end".
Outcome check_rest(const char* what, const char* verb, const Reference& there, bool yaw_free) {
  const double speed = there.velocity_ned.norm();
  const double turning = yaw_free ? 0.0 : std::abs(there.yaw_rate);
  if (speed > kJoin_m_s) return refuse("%s %ss at %.2f m/s, must %s at rest", what, verb, speed, verb);
  if (turning > kRest_rad_s)
    return refuse("%s %ss turning at %.2f rad/s, must %s at rest", what, verb, turning, verb);
  return accept();
}

// Limits that only a mission's own bounds set on ready-made segments: jerk and yaw rate.
Outcome check_own_bounds(const char* item, std::size_t number, const PolynomialSegment& segment,
                         const MissionBounds& bounds, bool yaw_free) {
  char what[64];
  std::snprintf(what, sizeof what, "%s: segment %zu", item, number);
  if (bounds.max_jerk > 0.0) {
    const Outcome outcome = check_length(what, segment, 3, bounds.max_jerk, "m/s^3");
    if (!outcome.accepted) return outcome;
  }
  if (bounds.max_yaw_rate <= 0.0 || yaw_free) return accept();
  const Bernstein rate = bernstein(segment.yaw, segment.duration_s, 1);
  const double precision = kExtremumPrecision * bounds.max_yaw_rate;
  const double reached = std::max(maximum(rate, precision).value, -minimum(rate, precision).value);
  if (reached <= bounds.max_yaw_rate + precision) return accept();
  return refuse("%s reaches a yaw rate of %.2f rad/s, the limit is %.2f rad/s", what, reached,
                bounds.max_yaw_rate);
}

Outcome check_item_trajectory(const char* what, const Mission& mission, const MissionItem& item,
                              const Limits& limits) {
  const std::size_t there = mission.segments.size();
  const std::size_t end = std::size_t{item.first_segment} + item.segment_count;
  if (item.segment_count == 0) return refuse("%s: the trajectory has no segments", what);
  if (end > there) {
    return refuse("%s: the trajectory ends at segment %zu, the mission has %zu", what, end, there);
  }
  char of[40];
  std::snprintf(of, sizeof of, "%s: ", what);
  const PolynomialSegment* const first = mission.segments.data() + item.first_segment;
  Outcome outcome = check_segments(of, first, item.segment_count, item.yaw_free, limits);
  for (std::size_t i = 0; outcome.accepted && i < item.segment_count; ++i)
    outcome = check_own_bounds(what, i + 1, first[i], mission.bounds, item.yaw_free);
  return outcome;
}

Outcome check_item_end(const char* what, const MissionItem& item, const Limits& limits) {
  Eigen::Vector3d position = item.position_ned;
  if (item.kind == MissionItemKind::kTakeoff)
    position.head<2>() = 0.5 * (limits.fence_min_ned + limits.fence_max_ned).head<2>();
  const Outcome outcome = check_position(what, position, limits);
  return outcome.accepted && !item.yaw_free ? check_yaw(what, item.yaw_rad) : outcome;
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

Outcome check_position(InFrame named, const Eigen::Vector3d& position_ned, const Limits& limits) {
  const Outcome height = check_height(named, position_ned.z(), limits);
  if (!height.accepted && position_ned.allFinite()) return height;
  return check_inside_fence(named, position_ned, limits);
}

Outcome check_position(const char* what, const Eigen::Vector3d& position_ned, const Limits& limits) {
  return check_position(InFrame{what, Frame::kNed}, position_ned, limits);
}

Outcome check_inside_fence(const char* what, const Eigen::Vector3d& position_ned, const Limits& limits) {
  return check_inside_fence(InFrame{what, Frame::kNed}, position_ned, limits);
}

Outcome check_height(InFrame named, double z_ned, const Limits& limits) {
  const double least_m = limits.min_height_m;
  if (z_ned <= kPlaceTolerance_m - least_m) return accept();
  const bool down = named.frame == Frame::kNed;
  const double z = down ? z_ned : -z_ned;
  if (z_ned > 0.0) {
    return refuse(
        "%s: z = %+.3f m is below the ground, as z points %s (%s); %.3f m above the ground is z = %.3f m",
        named.what, z, down ? "down" : "up", frame_title(named.frame), z_ned, -z);
  }
  return refuse("%s: z = %.3f m is %.3f m above the ground; the minimum height is %.3f m, z = %.3f m",
                named.what, z, std::abs(z), least_m, down ? -least_m : least_m);
}

Outcome check_height(const char* what, double z_ned, const Limits& limits) {
  return check_height(InFrame{what, Frame::kNed}, z_ned, limits);
}

Outcome check_above_ground(InFrame named, double z_ned) {
  Limits any_height;
  any_height.min_height_m = 0.0;
  return check_height(named, z_ned, any_height);
}

Outcome check_above_ground(const char* what, double z_ned) {
  return check_above_ground(InFrame{what, Frame::kNed}, z_ned);
}

Outcome check_yaw(const char* what, double yaw_rad) {
  constexpr double kTurn_rad = 2.0 * M_PI;
  if (!std::isfinite(yaw_rad)) return refuse("%s: yaw is not a finite number", what);
  if (std::abs(yaw_rad) <= kTurn_rad) return accept();
  return refuse(
      "%s: yaw is %.6g rad, more than a full turn: %.6g degrees are %.4f rad, %.6g rad are the yaw %.4f rad",
      what, yaw_rad, yaw_rad, yaw_rad / 360.0 * kTurn_rad, yaw_rad, std::remainder(yaw_rad, kTurn_rad));
}

Outcome check_speed(const char* what, double speed, const Limits& limits) {
  if (std::isfinite(speed) && speed > 0.0 && speed <= limits.max_speed) return accept();
  return refuse("%s: speed is %.3f m/s, must be above 0 and at most %.3f m/s", what, speed, limits.max_speed);
}

Outcome check(const MissionBounds& bounds, const Limits& limits) {
  struct Bound {
    const char* name;
    double value;
    double limit;
    const char* unit;
  };
  for (const Bound& bound : {Bound{"speed", bounds.max_speed, limits.max_speed, "m/s"},
                             Bound{"acceleration", bounds.max_acceleration, limits.max_acceleration, "m/s^2"},
                             Bound{"jerk", bounds.max_jerk, limits.max_reference_jerk, "m/s^3"},
                             Bound{"yaw rate", bounds.max_yaw_rate, limits.max_yaw_rate, "rad/s"}}) {
    if (bound.value >= 0.0 && bound.value <= bound.limit) continue;
    return refuse("the mission's %s limit is %.3f %s, must be above 0 and at most %.3f %s", bound.name,
                  bound.value, bound.unit, bound.limit, bound.unit);
  }
  if (!bounds.fenced) return accept();
  Outcome outcome = check_inside_fence("the mission's fence, minimum corner", bounds.fence_min_ned, limits);
  Eigen::Vector3d lower = bounds.fence_max_ned;
  lower.z() = std::min(lower.z(), limits.fence_max_ned.z());
  if (outcome.accepted) outcome = check_inside_fence("the mission's fence, maximum corner", lower, limits);
  if (!outcome.accepted) return outcome;
  for (int i = 0; i < 3; ++i) {
    if (bounds.fence_max_ned[i] > bounds.fence_min_ned[i]) continue;
    return refuse("the mission's fence: maximum %c is %.3f m, must be above the minimum, %.3f m", "xyz"[i],
                  bounds.fence_max_ned[i], bounds.fence_min_ned[i]);
  }
  return accept();
}

Outcome check(const Mission& mission, const Limits& settings) {
  const Outcome bounded = check(mission.bounds, settings);
  if (!bounded.accepted) return bounded;
  const Limits limits = tightened(settings, mission.bounds);
  const std::size_t count = mission.items.size();
  if (count == 0) return refuse("the mission has no items");
  if (count > kMaxMissionItems)
    return refuse("the mission has %zu items, the limit is %d", count, kMaxMissionItems);
  if (mission.segments.size() > kMaxTrajectorySegments) {
    return refuse("the mission's trajectories have %zu segments, the limit is %d", mission.segments.size(),
                  kMaxTrajectorySegments);
  }
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
    if (!(item.acceptance_radius_m >= 0.0))
      return refuse("%s: acceptance radius is %.3f m, must be 0 or more", what, item.acceptance_radius_m);
    switch (item.kind) {
      case MissionItemKind::kTakeoff:
      case MissionItemKind::kWaypoint:
        outcome = check_item_end(what, item, limits);
        break;
      case MissionItemKind::kTrajectory:
        outcome = check_item_trajectory(what, mission, item, limits);
        break;
      case MissionItemKind::kLand:
      case MissionItemKind::kWait:
        break;
    }
    if (!outcome.accepted) return outcome;
  }
  return accept();
}

Outcome check(const Trajectory& trajectory, const Limits& limits) {
  const std::size_t count = trajectory.segments.size();
  if (count == 0) return refuse("the trajectory has no segments");
  if (count > kMaxTrajectorySegments) {
    return refuse("the trajectory has %zu segments, the limit is %d", count, kMaxTrajectorySegments);
  }
  return check_segments("", trajectory.segments.data(), count, false, limits);
}

Outcome check_segment(InFrame named, const PolynomialSegment& segment, const Limits& limits) {
  if (!std::isfinite(segment.duration_s) || segment.duration_s <= 0.0 ||
      segment.duration_s > kLongestSegment_s) {
    return refuse("%s: duration is %.3f s, must be above 0 and at most %.0f s", named.what,
                  segment.duration_s, kLongestSegment_s);
  }
  if (!finite(segment.x) || !finite(segment.y) || !finite(segment.z) || !finite(segment.yaw))
    return refuse("%s: a coefficient is not a finite number", named.what);
  return check_motion(named, segment, limits);
}

Outcome check_segment(const char* what, const PolynomialSegment& segment, const Limits& limits) {
  return check_segment(InFrame{what, Frame::kNed}, segment, limits);
}

Outcome check_motion(const char* what, const PolynomialSegment& segment, const Limits& limits) {
  return check_motion(InFrame{what, Frame::kNed}, segment, limits);
}

Outcome check_joint(const char* what, const PolynomialSegment& before, const PolynomialSegment& next) {
  const Reference end = evaluate(before, before.duration_s);
  const Reference start = evaluate(next, 0.0);
  const double step_m = (start.position_ned - end.position_ned).norm();
  const double step_m_s = (start.velocity_ned - end.velocity_ned).norm();
  if (step_m <= kJoin_m && step_m_s <= kJoin_m_s) return accept();
  return refuse("%s does not start where the previous one ends: %.3f m and %.3f m/s apart", what, step_m,
                step_m_s);
}

Outcome check_start(const char* what, const PolynomialSegment& first, bool yaw_free) {
  return check_rest(what, "start", evaluate(first, 0.0), yaw_free);
}

Outcome check_end(const char* what, const PolynomialSegment& last, bool yaw_free) {
  return check_rest(what, "end", evaluate(last, last.duration_s), yaw_free);
}

}  // namespace swiftlet::control
