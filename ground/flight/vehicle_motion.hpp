// Where a vehicle is and how far from its reference, by the newest messages.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "swiftlet/ground/client/client.hpp"

namespace swiftlet::ground {

// Where the vehicle is: by the ground truth, or of a vehicle without one, by the estimate of control.
struct Motion {
  std::int64_t stamp_ns = 0;
  std::uint64_t count = 0;  // of messages
  std::array<double, 3> position_ned{};
  std::array<double, 3> velocity_ned{};
};
inline Motion motion_of(const View& view) {
  const auto motion = [](const auto& latest) {
    const auto& message = latest.message;
    return Motion{message.stamp_ns(), latest.count, message.position_ned(), message.velocity_ned()};
  };
  return view.truth.seen() ? motion(view.truth) : motion(view.estimate);
}

// Distance of the vehicle from its reference. The newest of both may be of different stamps, a few milliseconds apart: the motion is
// carried on at its velocity.
inline double newest_error_m(const View& view) {
  const Motion motion = motion_of(view);
  if (motion.count == 0 || !view.reference.seen()) return std::numeric_limits<double>::quiet_NaN();
  const msg::Reference& reference = view.reference.message;
  const double ahead_s = 1e-9 * static_cast<double>(reference.stamp_ns() - motion.stamp_ns);
  const auto along = [&](std::size_t axis) {
    return motion.position_ned[axis] + ahead_s * motion.velocity_ned[axis] - reference.position_ned()[axis];
  };
  return std::hypot(along(0), along(1), along(2));
}

}  // namespace swiftlet::ground
