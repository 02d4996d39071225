// The reference over time: rest at a position, one constant reference, or polynomial segments in sequence.
#pragma once

#include <cstdint>
#include <type_traits>

#include "swiftlet/control/guidance/time_scaling.hpp"
#include "swiftlet/control/types/polynomial.hpp"

namespace swiftlet::control {

// Plain data, so that another process can take it over.
struct ReferencePath {
  bool moving = false;
  PolynomialSegment segment;  // if not moving, its start is the reference and duration_s is 0
  std::int64_t start_ns = 0;  // path time
  std::int64_t end_ns = 0;
  TimeScaling clock;  // of the path time

  // From now on, rest at the position and yaw of `at`.
  void rest(const Reference& at);
  // From now on, the constant reference `at`.
  void pin(const Reference& at);
  // Follows the segment from `from_ns`, vehicle time. Rests at its end afterwards.
  void follow(const PolynomialSegment& along, std::int64_t from_ns);
  // Follows the segment from the end of the present one, with the same time scaling.
  void follow_on(const PolynomialSegment& along);
  // After a pause: sets path time equal to vehicle time from now on. Returns the delay of path time before,
  // ns.
  std::int64_t take_vehicle_time(std::int64_t now_ns);

  // The arguments below are vehicle time.
  Reference at(std::int64_t now_ns) const;
  std::int64_t path_ns(std::int64_t now_ns) const { return clock.at(now_ns).at_ns; }
  bool finished(std::int64_t now_ns) const { return !moving || path_ns(now_ns) >= end_ns; }
};
static_assert(std::is_trivially_copyable_v<ReferencePath>);

}  // namespace swiftlet::control
