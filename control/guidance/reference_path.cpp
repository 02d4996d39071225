#include "swiftlet/control/guidance/reference_path.hpp"

#include <cmath>

#include "swiftlet/math/time.hpp"

namespace swiftlet::control {
namespace {

Reference at_rest(const Reference& at) {
  Reference rest;
  rest.position_ned = at.position_ned;
  rest.yaw_rad = at.yaw_rad;
  return rest;
}

// The Taylor polynomial for which evaluate(segment, 0) is `at`.
PolynomialSegment instant(const Reference& at) {
  const auto axis = [&](int i) {
    return Polynomial{at.position_ned[i], at.velocity_ned[i], at.acceleration_ned[i] / 2.0,
                      at.jerk_ned[i] / 6.0, at.snap_ned[i] / 24.0};
  };
  PolynomialSegment segment;
  segment.x = axis(0);
  segment.y = axis(1);
  segment.z = axis(2);
  segment.yaw = {at.yaw_rad, at.yaw_rate, at.yaw_acceleration / 2.0};
  return segment;
}

}  // namespace

void ReferencePath::rest(const Reference& at) { pin(at_rest(at)); }

void ReferencePath::pin(const Reference& at) {
  moving = false;
  segment = instant(at);
  clock = {};
}

void ReferencePath::follow(const PolynomialSegment& along, std::int64_t from_ns) {
  moving = true;
  segment = along;
  start_ns = from_ns;
  end_ns = from_ns + math::nanoseconds(along.duration_s);
  clock = {};
}

void ReferencePath::follow_on(const PolynomialSegment& along) {
  const TimeScaling same = clock;
  follow(along, end_ns);
  clock = same;
}

std::int64_t ReferencePath::take_vehicle_time(std::int64_t now_ns) {
  const std::int64_t behind_ns = now_ns - path_ns(now_ns);
  start_ns += behind_ns;
  end_ns += behind_ns;
  clock = {};
  return behind_ns;
}

Reference ReferencePath::at(std::int64_t now_ns) const {
  if (!moving) return evaluate(segment, 0.0);
  const PathTime time = clock.at(now_ns);
  if (time.at_ns >= end_ns) return at_rest(evaluate(segment, segment.duration_s));
  const Reference reference = evaluate(segment, static_cast<double>(time.at_ns - start_ns) * 1e-9);
  return clock.is_vehicle_time() ? reference : time_scaled(reference, time);
}

}  // namespace swiftlet::control
