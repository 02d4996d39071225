// The reference in time: rest at a place, one instant that stays, or one polynomial segment after another.
#pragma once

#include <cstdint>
#include <type_traits>

#include "control/trajectory/polynomial.hpp"

namespace swiftlet::control {

// Plain data, so that another process can go on with it where this one stopped.
struct ReferencePath {
  bool moving = false;
  PolynomialSegment segment;  // while not moving its first instant is the reference, and duration_s is 0
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;

  // Rest at the position and yaw of `at` from now on.
  void rest(const Reference& at);
  // The reference is `at`, as it is, until told otherwise.
  void pin(const Reference& at);
  // Follow the segment from `from_ns`; at its end, rest where it ends.
  void follow(const PolynomialSegment& along, std::int64_t from_ns);

  Reference at(std::int64_t now_ns) const;
  bool finished(std::int64_t now_ns) const { return !moving || now_ns >= end_ns; }
};
static_assert(std::is_trivially_copyable_v<ReferencePath>);

}  // namespace swiftlet::control
