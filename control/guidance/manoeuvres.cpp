#include "swiftlet/control/guidance/manoeuvres.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "swiftlet/control/guidance/setpoint_stream.hpp"
#include "swiftlet/control/guidance/spool_up.hpp"
#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/planning/waypoint_path.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::control {
namespace {

constexpr double kFlareHeight_m = 0.08;  // the planned path of a landing ends here, then the vehicle sinks
constexpr double kSinkSpeed = 0.15;      // m/s
constexpr double kSink_s = 60.0;         // longest duration
constexpr double kBlindDepth_m = 0.1;    // below the ground, by dead reckoning
constexpr double kMinMove_s = 0.5;
constexpr int kJoinAttempts = 16;  // attempts to join a trajectory from motion, each with more time
constexpr double kJoinStretch = 1.25;

double yaw_of(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

// The yaw equal to `to` up to whole turns that is nearest to `from`.
double nearest_turn(double to, double from) { return from + std::remainder(to - from, 2.0 * M_PI); }

// The braking manoeuvre from `from`, with its stopping point moved inside the fence. A reference that
// follows no path is at the vehicle's own motion.
BrakingManoeuvre brakes_inside_fence(const GuidanceContext& context, const Reference& from) {
  const Limits& limits = context.limits;
  return inside_fence(
      limits, from, context.state.path.moving ? brake_reference(limits, from) : brake_vehicle(limits, from));
}

double value_at(const Polynomial& polynomial, double t) {
  return std::accumulate(polynomial.rbegin(), polynomial.rend(), 0.0,
                         [t](double sum, double coefficient) { return sum * t + coefficient; });
}

// Sets one coordinate of the reference, and its rates to zero.
void rest_at(int axis, double position, Reference& reference) {
  reference.position_ned[axis] = position;
  for (Eigen::Vector3d* const rate :
       {&reference.velocity_ned, &reference.acceleration_ned, &reference.jerk_ned, &reference.snap_ned})
    (*rate)[axis] = 0.0;
}

// The minimum height, or the lower end of the segment if that is lower.
double lowest_z_on(const Limits& limits, const PolynomialSegment& segment) {
  return std::max({lowest_z_ned(limits), segment.z[0], value_at(segment.z, segment.duration_s)});
}

bool leaves_fence(const Limits& limits, const PolynomialSegment& segment) {
  constexpr int kSamples = 24;
  constexpr double kRounding_m = 1e-6;
  const double lowest = lowest_z_on(limits, segment) + kRounding_m;
  for (int i = 1; i < kSamples; ++i) {
    Reference at = evaluate(segment, segment.duration_s * i / kSamples);
    const Eigen::Vector3d position_ned = at.position_ned;
    clamp_to_fence(limits, at);
    if (at.position_ned != position_ned || position_ned.z() > lowest) return true;
  }
  return false;
}

// A long quintic from motion swings out far. Where it would leave the fence, the reference drops as much of
// its initial speed at once as needed. From rest the path is straight.
PolynomialSegment join_inside(const Limits& limits, Reference from, const Eigen::Vector3d& to_ned,
                              double to_yaw, double duration_s) {
  constexpr int kParts = 4;
  const Reference as_it_is = from;
  for (int kept = kParts;; --kept) {
    const double part = static_cast<double>(kept) / kParts;
    from.velocity_ned = part * as_it_is.velocity_ned;
    from.acceleration_ned = part * as_it_is.acceleration_ned;
    const PolynomialSegment segment = join_to_rest(from, to_ned, to_yaw, duration_s);
    const bool straight = from.velocity_ned.isZero(0.0) && from.acceleration_ned.isZero(0.0);
    if (straight || !leaves_fence(limits, segment)) return segment;
  }
}

// The planned part of a landing is over: sinks until touchdown is detected.
void sink(const GuidanceContext& context) {
  GuidanceState& state = context.state;
  state.phase = Phase::kSink;
  const Reference end = state.path.at(context.now_ns);
  PolynomialSegment down;
  down.duration_s = kSink_s;
  down.x = {end.position_ned.x()};
  down.y = {end.position_ned.y()};
  down.z = {end.position_ned.z(), kSinkSpeed};
  down.yaw = {end.yaw_rad};
  state.path.follow(down, context.now_ns);
}

double clock_change_s(const Limits& limits, double speed) {
  return clock_change_duration(speed, limits.max_reference_acceleration, limits.max_reference_jerk,
                               kMinMove_s);
}

const MissionItem& item_of(const GuidanceContext& context) {
  return context.plan.mission->items[static_cast<std::size_t>(context.state.mission.item_index)];
}

// Follows the next segment whenever one ends. keep_yaw: ignores the yaw of the segments.
void advance_segments(const GuidanceContext& context, const PolynomialSegment* segments, std::size_t count,
                      bool keep_yaw) {
  GuidanceState& state = context.state;
  while (state.next_segment < count && state.path.finished(context.now_ns)) {
    PolynomialSegment segment = segments[state.next_segment++];
    if (keep_yaw) segment.yaw = {state.path.at(context.now_ns).yaw_rad};
    state.path.follow_on(segment);
  }
}

// True if the reference rests at the item's end and, if the item asks for that, the vehicle is near.
bool arrived(const GuidanceContext& context) {
  const GuidanceState& state = context.state;
  const MissionItem& item = item_of(context);
  if (!state.path.finished(context.now_ns)) return false;
  if (item.acceptance_radius_m <= 0.0) return true;
  const Eigen::Vector3d end = state.path.at(context.now_ns).position_ned;
  return (context.estimate.position_ned - end).norm() <= item.acceptance_radius_m;
}

// Follows the segments of a trajectory item; other items have one segment only. Sets the item's end on
// arrival.
void advance_item(const GuidanceContext& context) {
  GuidanceState& state = context.state;
  const MissionItem& item = item_of(context);
  if (item.kind == MissionItemKind::kTrajectory) {
    advance_segments(context, context.plan.mission->segments.data() + item.first_segment, item.segment_count,
                     item.yaw_free);
  }
  if (state.item_end_ns != 0 || !arrived(context)) return;
  const bool awaited = item.acceptance_radius_m > 0.0;
  state.item_end_ns =
      (awaited ? state.path.path_ns(context.now_ns) : state.path.end_ns) + math::nanoseconds(item.hold_s);
}

// At the point where the mission was paused: resumes its path from rest.
void resume_paused_path(const GuidanceContext& context) {
  GuidanceState& state = context.state;
  state.path.follow(state.paused_path.segment, context.now_ns);
  state.path.start_ns = state.paused_path.start_ns;
  state.path.end_ns = state.paused_path.end_ns;
  state.path.clock = TimeScaling::standing_at(state.paused_path.at_ns, context.now_ns);
  state.pause = MissionPause::kNone;
  change_time_scaling(context, true);
}

// While the time scaling changes, only the item's own path advances.
void advance_mission(const GuidanceContext& context) {
  GuidanceState& state = context.state;
  const bool on_item_path = state.pause == MissionPause::kNone;
  if (state.path.clock.is_changing(context.now_ns)) {
    if (on_item_path) advance_item(context);
    return;
  }
  if (!state.path.clock.is_vehicle_time()) {
    const std::int64_t behind_ns = state.path.take_vehicle_time(context.now_ns);
    if (on_item_path && state.item_end_ns != 0)
      state.item_end_ns = std::max(state.item_end_ns + behind_ns, context.now_ns);
  }
  if (!state.path.finished(context.now_ns)) return;
  if (state.pause == MissionPause::kReturning) return resume_paused_path(context);
  if (item_of(context).kind == MissionItemKind::kLand) return sink(context);
  advance_item(context);
  if (state.item_end_ns == 0 || !state.path.finished(context.now_ns)) return;
  if (context.now_ns < state.item_end_ns || state.mission.item_index + 1 >= state.mission.item_count) return;
  ++state.mission.item_index;
  start_item(context, state.item_end_ns);
}

void advance_trajectory(const GuidanceContext& context) {
  const auto& segments = context.plan.trajectory->segments;
  advance_segments(context, segments.data(), segments.size(), false);
}

// The greatest speed on the path until a change of the time scaling would be over, as bounds of its segments
// show.
double max_speed_ahead(const GuidanceContext& context) {
  const MotionLimits unit{1.0, 1.0, 1.0, 1.0};
  const GuidanceState& state = context.state;
  if (!state.path.moving) return 0.0;
  double speed = limit_use(state.path.segment, unit).speed;
  const MissionItem& item = item_of(context);
  if (item.kind != MissionItemKind::kTrajectory || state.pause != MissionPause::kNone) return speed;
  double ahead_s = elapsed_s(state.path.path_ns(context.now_ns), state.path.end_ns);
  for (std::uint32_t next = state.next_segment;
       next < item.segment_count && ahead_s < clock_change_s(context.limits, speed); ++next) {
    const PolynomialSegment& segment = context.plan.mission->segments[item.first_segment + next];
    speed = std::max(speed, limit_use(segment, unit).speed);
    ahead_s += segment.duration_s;
  }
  return speed;
}

}  // namespace

void clamp_to_fence(const Limits& limits, Reference& reference) {
  for (int i = 0; i < 3; ++i) {
    const double at = reference.position_ned[i];
    const bool beyond = at < limits.fence_min_ned[i] || (i < 2 && at > limits.fence_max_ned[i]);
    if (!beyond) continue;
    rest_at(i, at < limits.fence_min_ned[i] ? limits.fence_min_ned[i] : limits.fence_max_ned[i], reference);
  }
}

Reference reference_on_path(const GuidanceContext& context, std::int64_t at_ns) {
  const ReferencePath& path = context.state.path;
  Reference at = path.at(at_ns);
  const double lowest = lowest_z_on(context.limits, path.segment);
  if (at.position_ned.z() > lowest) rest_at(2, lowest, at);
  return at;
}

Limits limits_from(const Limits& limits, double z_ned) {
  Limits from = limits;
  from.min_height_m = std::min(limits.min_height_m, -z_ned);
  from.fence_max_ned.z() = std::max(limits.fence_max_ned.z(), z_ned);
  return from;
}

Reference standing_at(const Estimate& estimate) {
  Reference reference;
  reference.position_ned = estimate.position_ned;
  reference.yaw_rad = yaw_of(estimate.q_ned_from_frd);
  return reference;
}

BrakingManoeuvre brake_reference(const Limits& limits, const Reference& from) {
  return limited_braking(from, limits.max_reference_acceleration, limits.max_reference_jerk, kMinMove_s);
}

BrakingManoeuvre brake_vehicle(const Limits& limits, const Reference& from) {
  const double duration_s =
      std::max(kMinMove_s, 2.0 * from.velocity_ned.norm() / limits.max_reference_acceleration);
  return {duration_s, from.position_ned + 0.5 * duration_s * from.velocity_ned};
}

BrakingManoeuvre inside_fence(const Limits& limits, const Reference& from, BrakingManoeuvre stop) {
  stop.place_ned = stop.place_ned.cwiseMax(limits.fence_min_ned).cwiseMin(limits.fence_max_ned);
  const double below_m = stop.place_ned.z() - lowest_z_ned(limits);
  if (below_m <= 0.0) return stop;
  stop.place_ned.z() -= below_m;
  const double ascent_m = std::max(from.position_ned.z() - stop.place_ned.z(), 0.0);
  const double ascent_s = minimum_jerk_duration(ascent_m, limits.max_speed, limits.max_reference_acceleration,
                                                limits.max_reference_jerk, kMinMove_s);
  stop.duration_s = std::max(stop.duration_s, ascent_s);
  return stop;
}

void start_move(const GuidanceContext& context, const Eigen::Vector3d& to_ned, bool yaw_free, double yaw_rad,
                double speed, std::int64_t start_ns) {
  const Limits& limits = context.limits;
  const Reference from = reference_on_path(context, start_ns);
  const double to_yaw = yaw_free ? from.yaw_rad : nearest_turn(yaw_rad, from.yaw_rad);
  const double distance = (to_ned - from.position_ned).norm();
  double duration = minimum_jerk_duration(distance, speed, limits.max_reference_acceleration,
                                          limits.max_reference_jerk, kMinMove_s);
  duration = std::max(duration, 15.0 / 8.0 * std::abs(to_yaw - from.yaw_rad) / limits.max_yaw_rate);
  duration = std::max(duration, brakes_inside_fence(context, from).duration_s);
  context.state.phase = Phase::kPath;
  context.state.path.follow(join_inside(limits, from, to_ned, to_yaw, duration), start_ns);
}

void start_join(const GuidanceContext& context, const PolynomialSegment& first, bool keep_yaw, double speed,
                std::int64_t start_ns) {
  const Limits& limits = context.limits;
  GuidanceState& state = context.state;
  const Reference from = reference_on_path(context, start_ns);
  Reference to = evaluate(first, 0.0);
  to.yaw_rad = keep_yaw ? from.yaw_rad : nearest_turn(to.yaw_rad, from.yaw_rad);
  if (keep_yaw) to.yaw_rate = to.yaw_acceleration = 0.0;
  state.phase = Phase::kPath;
  state.next_segment = 0;
  // From rest the join is straight, in the time that it takes. From motion it swings out further the longer
  // it takes, and accelerates more the shorter it takes. The first within the acceleration limit is taken,
  // or else the one with the least acceleration.
  const bool moves = !from.velocity_ned.isZero(0.0) || !from.acceleration_ned.isZero(0.0);
  const double gentle = (1.0 + 1e-5) * std::max({limits.max_reference_acceleration,
                                                 from.acceleration_ned.norm(), to.acceleration_ned.norm()});
  const MotionLimits unit{1.0, 1.0, 1.0, 1.0};
  const Limits in_force = limits_from(limits, from.position_ned.z());
  PolynomialSegment gentlest;
  double least = std::numeric_limits<double>::infinity();  // m/s^2, its peak acceleration
  double duration = kMinMove_s;
  if (!moves) {
    duration = septic_duration((to.position_ned - from.position_ned).norm(), speed,
                               limits.max_reference_acceleration, limits.max_reference_jerk, kMinMove_s);
  }
  duration = std::max(duration, 35.0 / 16.0 * std::abs(to.yaw_rad - from.yaw_rad) / limits.max_yaw_rate);
  for (int attempt = 0; attempt < kJoinAttempts && least > gentle; ++attempt, duration *= kJoinStretch) {
    const PolynomialSegment candidate = join(from, to, duration);
    if (!check_motion("join", candidate, in_force).accepted) continue;
    const double acceleration = limit_use(candidate, unit).acceleration;
    if (acceleration >= least) continue;
    least = acceleration;
    gentlest = candidate;
  }
  if (std::isfinite(least)) return state.path.follow(gentlest, start_ns);
  start_move(context, to.position_ned, false, to.yaw_rad, speed, start_ns);
}

void start_stop(const GuidanceContext& context) {
  GuidanceState& state = context.state;
  const Reference from = reference_on_path(context, context.now_ns);
  const BrakingManoeuvre stop = brakes_inside_fence(context, from);
  state.phase = Phase::kPath;
  state.path.follow(join_to_rest(from, stop.place_ned, from.yaw_rad, stop.duration_s), context.now_ns);
}

void start_landing(const GuidanceContext& context, double speed, std::int64_t start_ns) {
  const Reference from = context.state.path.at(start_ns);
  Eigen::Vector3d above_ground = brakes_inside_fence(context, from).place_ned;
  above_ground.z() = std::max(context.state.ground_z_ned - kFlareHeight_m, from.position_ned.z());
  start_move(context, above_ground, true, 0.0, speed, start_ns);
}

void change_time_scaling(const GuidanceContext& context, bool to_running) {
  GuidanceState& state = context.state;
  state.path.clock.turn(to_running, clock_change_s(context.limits, max_speed_ahead(context)), context.now_ns);
}

void pause_path(const GuidanceContext& context) {
  GuidanceState& state = context.state;
  if (state.pause == MissionPause::kNone) {
    const ReferencePath& way = state.path;
    const std::int64_t at_ns = way.path_ns(context.now_ns);
    state.paused_path = {way.segment, way.moving ? way.start_ns : at_ns, way.moving ? way.end_ns : at_ns,
                         at_ns};
  }
  state.pause = MissionPause::kAway;
}

void return_to_paused_path(const GuidanceContext& context) {
  GuidanceState& state = context.state;
  if (state.pause != MissionPause::kAway) return change_time_scaling(context, true);
  const PausedPath& paused_path = state.paused_path;
  const Reference place = evaluate(paused_path.segment, elapsed_s(paused_path.start_ns, paused_path.at_ns));
  start_move(context, place.position_ned, false, place.yaw_rad, item_of(context).speed, context.now_ns);
  state.pause = MissionPause::kReturning;
}

void start_item(const GuidanceContext& context, std::int64_t start_ns) {
  const MissionItem& item = item_of(context);
  context.state.item_end_ns = 0;
  context.state.pause = MissionPause::kNone;
  switch (item.kind) {
    case MissionItemKind::kTakeoff: {
      if (!context.state.flying()) return start_takeoff(context, item.position_ned.z(), item.speed, start_ns);
      Eigen::Vector3d up = context.state.path.at(start_ns).position_ned;
      up.z() = item.position_ned.z();
      return start_move(context, up, true, 0.0, item.speed, start_ns);
    }
    case MissionItemKind::kWaypoint:
      return start_move(context, item.position_ned, item.yaw_free, item.yaw_rad, item.speed, start_ns);
    case MissionItemKind::kLand:
      return start_landing(context, std::min(item.speed, context.failsafe.descent_speed), start_ns);
    case MissionItemKind::kTrajectory:
      return start_join(context, context.plan.mission->segments[item.first_segment], item.yaw_free,
                        item.speed, start_ns);
    case MissionItemKind::kWait:
      context.state.phase = Phase::kPath;
      context.state.path.rest(context.state.path.at(start_ns));
      context.state.path.start_ns = context.state.path.end_ns = start_ns;
      return;
  }
}

void advance(const GuidanceContext& context) {
  GuidanceState& state = context.state;
  if (!context.state.flying() || context.mode == Mode::kDescent) return;
  if (context.estimate.position_ned.z() < state.ground_z_ned - kAirborneHeight_m) state.airborne = true;
  if (context.mode == Mode::kSetpoint && goes_past_position(state.setpoint_kind))
    return follow_estimate(context);
  await_rotors(context);
  if (state.phase == Phase::kSpoolUp && context.now_ns >= state.phase_since_ns) advance_spool_up(context);
  if (state.phase != Phase::kPath) return;
  if (context.mode == Mode::kMission) return advance_mission(context);
  if (context.state.mission_paused() && state.pause == MissionPause::kNone) return advance_item(context);
  if (!state.path.finished(context.now_ns)) return;
  if (context.mode == Mode::kTrajectory) advance_trajectory(context);
  if (context.mode == Mode::kSetpoint) start_coast(context);
  if (context.mode == Mode::kLanding) sink(context);
}

Reference reference(const GuidanceContext& context) {
  if (!context.state.flying()) return standing_at(context.estimate);
  Reference now = reference_on_path(context, context.now_ns);
  clamp_to_fence(context.limits, now);
  return now;
}

bool plan_finished(const GuidanceContext& context) {
  const GuidanceState& state = context.state;
  if (state.phase != Phase::kPath || !state.path.finished(context.now_ns)) return false;
  switch (context.mode) {
    case Mode::kTakingOff:
      return true;
    case Mode::kMission:
      return state.mission.item_index + 1 == state.mission.item_count && state.item_end_ns != 0 &&
             context.now_ns >= state.item_end_ns && !state.path.clock.is_changing(context.now_ns);
    case Mode::kTrajectory:
      return state.next_segment == context.plan.trajectory->segments.size();
    default:
      return false;
  }
}

bool on_landing_item(const GuidanceContext& context) {
  return context.mode == Mode::kMission && item_of(context).kind == MissionItemKind::kLand;
}

double blind_descent_speed(const GuidanceContext& context) {
  const bool below_ground = context.estimate.position_ned.z() > context.state.ground_z_ned + kBlindDepth_m;
  return (below_ground ? 2.0 : 1.0) * context.failsafe.descent_speed;
}

}  // namespace swiftlet::control
