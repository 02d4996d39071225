#include "swiftlet/control/guidance/time_scaling.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/math/time.hpp"

namespace swiftlet::control {
namespace {

// The integral of the polynomial from 0 to t.
double integral(const Polynomial& p, double t) {
  double sum = 0.0;
  for (std::size_t i = p.size(); i-- > 0;) sum = sum * t + p[i] / static_cast<double>(i + 1);
  return sum * t;
}

}  // namespace

std::int64_t TimeScaling::change_end_ns() const { return change_ns + math::nanoseconds(change_s); }

void TimeScaling::turn(bool to_running, double duration_s, std::int64_t now_ns) {
  const PathTime now = at(now_ns);
  runs = to_running;
  change_ns = now_ns;
  from_ns = now.at_ns;
  change_s = duration_s;
  rate = quintic_to_rest(now.rate, now.acceleration, now.jerk, to_running ? 1.0 : 0.0, duration_s);
}

TimeScaling TimeScaling::standing_at(std::int64_t path_ns, std::int64_t now_ns) {
  TimeScaling clock;
  clock.runs = false;
  clock.change_ns = now_ns;
  clock.from_ns = path_ns;
  return clock;
}

PathTime TimeScaling::at_own_pace(std::int64_t now_ns) const {
  if (!is_changing(now_ns)) {
    const std::int64_t run_ns = runs ? now_ns - change_end_ns() : 0;
    const std::int64_t changed_ns = change_s > 0.0 ? math::nanoseconds(integral(rate, change_s)) : 0;
    return {from_ns + changed_ns + run_ns, runs ? 1.0 : 0.0};
  }
  const double t = std::max(static_cast<double>(now_ns - change_ns) * 1e-9, 0.0);
  PathTime time{from_ns + math::nanoseconds(integral(rate, t)), 0.0};
  for (std::size_t i = rate.size(); i-- > 0;) {  // Horner's scheme, the k-th derivative over k!
    time.snap = time.snap * t + time.jerk;
    time.jerk = time.jerk * t + time.acceleration;
    time.acceleration = time.acceleration * t + time.rate;
    time.rate = time.rate * t + rate[i];
  }
  time.jerk *= 2.0;
  time.snap *= 6.0;
  return time;
}

double clock_change_duration(double speed, double acceleration, double jerk, double min_duration_s) {
  return std::max(
      {15.0 / 8.0 * speed / acceleration, std::sqrt(10.0 / std::sqrt(3.0) * speed / jerk), min_duration_s});
}

Reference time_scaled(const Reference& reference, const PathTime& time) {
  const double r = time.rate;
  const double a = time.acceleration;
  const Reference& p = reference;
  Reference slow = reference;
  slow.velocity_ned = r * p.velocity_ned;
  slow.acceleration_ned = r * r * p.acceleration_ned + a * p.velocity_ned;
  slow.jerk_ned = r * r * r * p.jerk_ned + 3.0 * r * a * p.acceleration_ned + time.jerk * p.velocity_ned;
  slow.snap_ned = r * r * r * r * p.snap_ned + 6.0 * r * r * a * p.jerk_ned +
                  (3.0 * a * a + 4.0 * r * time.jerk) * p.acceleration_ned + time.snap * p.velocity_ned;
  slow.yaw_rate = r * p.yaw_rate;
  slow.yaw_acceleration = r * r * p.yaw_acceleration + a * p.yaw_rate;
  return slow;
}

}  // namespace swiftlet::control
