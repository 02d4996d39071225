// The reference in time: rest at a place, one instant that stays, or one polynomial segment after another.
#pragma once

#include <cstdint>
#include <type_traits>

#include "swiftlet/control/guidance/time_scaling.hpp"
#include "swiftlet/control/types/polynomial.hpp"

namespace swiftlet::control {

// Plain data, so that another process can go on with it where this one stopped.
struct ReferencePath {
  bool moving = false;
  PolynomialSegment segment;  // while not moving its first instant is the reference, and duration_s is 0
  std::int64_t start_ns = 0;  // of the path's own time
  std::int64_t end_ns = 0;
  TimeScaling clock;  // of that

  // Rest at the position and yaw of `at` from now on.
  void rest(const Reference& at);
  // The reference is `at`, as it is, until told otherwise.
  void pin(const Reference& at);
  // Follow the segment from `from_ns`, vehicle's time; at its end, rest where it ends.
  void follow(const PolynomialSegment& along, std::int64_t from_ns);
  // Follow the segment from where this one ends, by the same clock.
  void follow_on(const PolynomialSegment& along);
  // Of a clock that runs again: from now on the path's time is the vehicle's. Returns by how much it was
  // behind, ns.
  std::int64_t take_vehicle_time(std::int64_t now_ns);

  // What follows is asked for by the vehicle's time.
  Reference at(std::int64_t now_ns) const;
  std::int64_t path_ns(std::int64_t now_ns) const { return clock.at(now_ns).at_ns; }
  bool finished(std::int64_t now_ns) const { return !moving || path_ns(now_ns) >= end_ns; }
};
static_assert(std::is_trivially_copyable_v<ReferencePath>);

}  // namespace swiftlet::control
