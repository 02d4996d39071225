#include "swiftlet/control/guidance/setpoint_stream.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "swiftlet/control/guidance/manoeuvres.hpp"
#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/planning/waypoint_path.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Vector3d;

constexpr double kLeastPeriod_s = 0.1;  // shortest blend, for faster streams
constexpr int kAttempts = 16;           // attempts to blend, each with more time
constexpr double kStretch = 1.25;
constexpr double kRoundingError = 1e-5;
constexpr double kReaction_s = 0.15;    // delay until the thrust acts against the motion
constexpr double kPastTimeout_s = 0.1;  // coasting outlasts the stream's time-out
// A blend's yaw rate keeps this share of its distance from the limit free: it may be higher between the looks at it.
constexpr double kBetweenLooks = 0.05;

// Where in its time a blend's yaw rate is held to the limit, dense at both ends.
struct Look {
  double s;
  double bump;  // s^2 (1 - s)^2
};
const std::array<Look, 63> kYawRateLooks = [] {
  std::array<Look, 63> looks{};
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const double s = 0.5 - 0.5 * std::cos(M_PI * static_cast<double>(i + 1) / 64.0);
    looks[i] = {s, s * s * (1.0 - s) * (1.0 - s)};
  }
  return looks;
}();

// The setpoint extrapolated to duration_s after it arrived: at constant acceleration until the next is due,
// then at constant velocity.
Reference carried_on(const Setpoint& to, double duration_s, double period_s) {
  const double accelerated_s = std::min(duration_s, period_s);
  const double rest_s = duration_s - accelerated_s;
  Reference end;
  end.velocity_ned = to.velocity_ned + accelerated_s * to.acceleration_ned;
  end.position_ned = to.position_ned + accelerated_s * to.velocity_ned +
                     0.5 * accelerated_s * accelerated_s * to.acceleration_ned + rest_s * end.velocity_ned;
  if (rest_s <= 0.0) end.acceleration_ned = to.acceleration_ned;
  return end;
}

// The integral of a polynomial that starts at `start`.
Polynomial integral(double start, const Polynomial& of) {
  Polynomial result{};
  result[0] = start;
  for (std::size_t i = 0; i + 1 < result.size(); ++i) result[i + 1] = of[i] / static_cast<double>(i + 1);
  return result;
}

// The quintic from a value and two derivatives to another value and rate, with zero second derivative, after
// time t. A fast stream replaces it again and again by a new one from the present state. This converges: the
// error then obeys s^3 + 9/t s^2 + 36/t^2 s + 60/t^3.
Polynomial quintic(double value, double rate, double change, double to_value, double to_rate, double t) {
  const double dv = to_value - (value + rate * t + 0.5 * change * t * t);
  const double dr = (to_rate - (rate + change * t)) * t;
  const double dc = -change * t * t;
  const double t3 = t * t * t;
  return {value,
          rate,
          0.5 * change,
          (10.0 * dv - 4.0 * dr + 0.5 * dc) / t3,
          (-15.0 * dv + 7.0 * dr - dc) / (t3 * t),
          (6.0 * dv - 3.0 * dr + 0.5 * dc) / (t3 * t * t)};
}

// The cubic from acceleration a with derivative j to `acceleration` with derivative 0, after time t.
Polynomial acceleration_blend(double a, double j, double acceleration, double t) {
  const double da = acceleration - (a + j * t);
  const double dj = -j * t;
  return {a, j, (3.0 * da - dj) / (t * t), (-2.0 * da + dj) / (t * t * t)};
}

// A quintic's rate without its part that turns: with bend s^2 (1 - s)^2 more, where s = t / duration, it turns by
// bend * duration / 30 more, with the same rates and accelerations at both ends.
struct YawRate {
  Polynomial plain;
  // So far it can be bent within the limit; none if least_bend is greater.
  double least_bend = -std::numeric_limits<double>::infinity();
  double greatest_bend = std::numeric_limits<double>::infinity();

  bool is_within() const { return least_bend <= greatest_bend; }
};

YawRate yaw_rate(double from_rate, double from_acceleration, double to_rate, double t, double most) {
  YawRate result{acceleration_blend(from_rate, from_acceleration, to_rate, t)};
  const Polynomial& plain = result.plain;
  for (const auto& [s, bump] : kYawRateLooks) {
    const double rate = plain[0] + s * t * (plain[1] + s * t * (plain[2] + s * t * plain[3]));
    const double below = most - rate;
    const double above = -most - rate;
    result.greatest_bend = std::min(result.greatest_bend, (below - kBetweenLooks * std::abs(below)) / bump);
    result.least_bend = std::max(result.least_bend, (above + kBetweenLooks * std::abs(above)) / bump);
  }
  return result;
}

// Yaw from the present one to that of the setpoint, as far as the limit of the yaw rate allows within the time. Its rate is
// continuous, and its acceleration too, unless the limit would then be exceeded: a long blend cannot bend as fast as the short
// one that it replaces.
Polynomial turn(const Limits& limits, const Reference& from, const Setpoint& to, double t) {
  const double most = std::max({limits.max_yaw_rate, std::abs(from.yaw_rate), std::abs(to.yaw_rate)});
  YawRate rate = yaw_rate(from.yaw_rate, from.yaw_acceleration, to.yaw_rate, t, most);
  if (!rate.is_within()) rate = yaw_rate(from.yaw_rate, 0.0, to.yaw_rate, t, most);
  double bend = 0.0;
  if (!to.yaw_free) {
    double turned = 0.0;  // without a bend
    for (int i = 3; i >= 0; --i) turned = t * (turned + rate.plain[static_cast<std::size_t>(i)] / (i + 1));
    const double missing = std::remainder(to.yaw_rad + to.yaw_rate * t - from.yaw_rad, 2.0 * M_PI);
    bend = 30.0 * (missing - turned) / t;
  }
  if (rate.is_within()) bend = std::clamp(bend, rate.least_bend, rate.greatest_bend);
  Polynomial bent = rate.plain;
  bent[2] += bend / (t * t);
  bent[3] -= 2.0 * bend / (t * t * t);
  bent[4] += bend / (t * t * t * t);
  return integral(from.yaw_rad, bent);
}

PolynomialSegment blend_in(const Limits& limits, const Reference& from, const Setpoint& to, double duration_s,
                           double period_s) {
  PolynomialSegment segment = join(from, carried_on(to, duration_s, period_s), duration_s);
  segment.yaw = turn(limits, from, to, duration_s);
  if (to.kind == SetpointKind::kPosition) return segment;
  const std::array<Polynomial*, 3> axes = {&segment.x, &segment.y, &segment.z};
  for (int i = 0; i < 3; ++i) {
    const double p = from.position_ned[i];
    const double v = from.velocity_ned[i];
    const double a = from.acceleration_ned[i];
    const double j = from.jerk_ned[i];
    *axes[static_cast<std::size_t>(i)] =
        to.kind == SetpointKind::kVelocity
            ? integral(p, quintic(v, a, j, to.velocity_ned[i], to.acceleration_ned[i], duration_s))
            : integral(p, integral(v, acceleration_blend(a, j, to.acceleration_ned[i], duration_s)));
  }
  return segment;
}

}  // namespace

PolynomialSegment blend(const Limits& limits, const Reference& from, const Setpoint& to, double period_s) {
  const MotionLimits unit{1.0, 1.0, 1.0, 1.0};
  const double acceleration =
      std::max({limits.max_reference_acceleration, from.acceleration_ned.norm(), to.acceleration_ned.norm()});
  const double jerk = std::max(limits.max_reference_jerk, from.jerk_ned.norm());
  const Limits in_force = limits_from(limits, from.position_ned.z());
  PolynomialSegment gentlest;
  double least = std::numeric_limits<double>::infinity();  // greatest use of the acceleration and jerk limits
  double duration = period_s;
  for (int attempt = 0; attempt < kAttempts && least > 1.0 + kRoundingError;
       ++attempt, duration *= kStretch) {
    const PolynomialSegment candidate = blend_in(limits, from, to, duration, period_s);
    const LimitUse use = limit_use(candidate, unit);
    const double most = std::max(use.acceleration / acceleration, use.jerk / jerk);
    if (most >= least || !check_motion("setpoint", candidate, in_force).accepted) continue;
    least = most;
    gentlest = candidate;
  }
  if (std::isfinite(least)) return gentlest;
  // From outside the fence, or above the speed limit: brakes to rest as fast as allowed.
  const BrakingManoeuvre stop = inside_fence(limits, from, brake_reference(limits, from));
  PolynomialSegment rest = join_to_rest(from, stop.place_ned, from.yaw_rad, stop.duration_s);
  Setpoint unturned;
  unturned.yaw_free = true;
  rest.yaw = turn(limits, from, unturned, stop.duration_s);
  return rest;
}

Reference after_blend(const PolynomialSegment& blend, double after_s) {
  const Reference at = evaluate(blend, std::min(after_s, blend.duration_s));
  const double beyond_s = after_s - blend.duration_s;
  return beyond_s > 0.0 ? evaluate(coast(at, beyond_s), beyond_s) : at;
}

PolynomialSegment coast(const Reference& from, double duration_s) {
  const auto axis = [&](int i) {
    return Polynomial{from.position_ned[i], from.velocity_ned[i], 0.5 * from.acceleration_ned[i]};
  };
  return {duration_s, axis(0), axis(1), axis(2), {from.yaw_rad, from.yaw_rate}};
}

double stream_period_s(const GuidanceContext& context) {
  const GuidanceState& state = context.state;
  if (context.mode != Mode::kSetpoint) return kLeastPeriod_s;
  const double since_s = elapsed_s(state.setpoint_ns, context.now_ns);
  return std::clamp(since_s, kLeastPeriod_s, std::max(kLeastPeriod_s, context.failsafe.setpoint_timeout_s));
}

void follow_path(const GuidanceContext& context, const PolynomialSegment& segment) {
  context.state.phase = Phase::kPath;
  context.state.path.follow(segment, context.now_ns);
}

void start_coast(const GuidanceContext& context) {
  GuidanceState& state = context.state;
  const PolynomialSegment& blended = state.path.segment;
  state.path.follow(
      coast(evaluate(blended, blended.duration_s), context.failsafe.setpoint_timeout_s + kPastTimeout_s),
      state.path.end_ns);
}

void take_direct(const GuidanceContext& context, const Setpoint& setpoint) {
  const Eigen::Quaterniond& q = setpoint.q_ned_from_frd;
  const Vector3d& rates = setpoint.body_rates_frd;
  context.state.phase = Phase::kPath;
  context.state.direct = {
      {q.w(), q.x(), q.y(), q.z()}, {rates.x(), rates.y(), rates.z()}, setpoint.specific_thrust};
  follow_estimate(context);
}

void follow_estimate(const GuidanceContext& context) {
  const Estimate& estimate = context.estimate;
  Reference here = standing_at(estimate);
  here.velocity_ned = estimate.velocity_ned;
  const Vector3d thrust_ned =
      estimate.q_ned_from_frd * Vector3d(0.0, 0.0, -context.state.direct.specific_thrust);
  const double limit = context.limits.max_acceleration;
  here.acceleration_ned = thrust_ned + Vector3d(0.0, 0.0, plant::kGravity);
  here.acceleration_ned *= limit / std::max(limit, here.acceleration_ned.norm());
  context.state.path.pin(here);
}

bool violates_fence(const GuidanceContext& context) {
  const Limits& limits = context.limits;
  Reference here;
  here.position_ned = context.estimate.position_ned + kReaction_s * context.estimate.velocity_ned;
  here.velocity_ned = context.estimate.velocity_ned;
  const Vector3d rest = brake_vehicle(limits, here).place_ned;
  return (rest.array() < limits.fence_min_ned.array()).any() ||
         (rest.array() > limits.fence_max_ned.array()).any() || rest.z() > lowest_z_ned(limits);
}

}  // namespace swiftlet::control
