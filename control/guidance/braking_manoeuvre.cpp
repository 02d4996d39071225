#include "swiftlet/control/guidance/braking_manoeuvre.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::control {

// With s = t/T, the acceleration is (1 - s) ((1 - 3 s) a - 6 s v/T). Its length is at most
//   (1 - s) (|1 - 3 s| |a| + 6 s |v|/T).
// The peak of this bound after s = 1/3, (2 |a| + w)^2 / (4 (3 |a| + w)) with w = 6 |v|/T, stays below a
// limit A for
//   w <= 2 (A - |a| + sqrt(A (A + |a|))),
// and the part before s = 1/3 stays below A as well. The jerk is linear in t; its end values are -(6 v/T^2 +
// 4 a/T) and 6 v/T^2 + 2 a/T.
BrakingManoeuvre limited_braking(const Reference& from, double peak_acceleration, double peak_jerk,
                                 double min_duration_s) {
  const double v = from.velocity_ned.norm();
  const double a = from.acceleration_ned.norm();
  const double most = std::max(a, peak_acceleration);
  const double jerk = peak_jerk * most / peak_acceleration;
  const double for_acceleration = 3.0 * v / (most - a + std::sqrt(most * (most + a)));
  const double for_jerk = (2.0 * a + std::sqrt(4.0 * a * a + 6.0 * jerk * v)) / jerk;
  const double t = std::max({for_acceleration, for_jerk, min_duration_s});
  return {t, from.position_ned + t * (0.5 * from.velocity_ned + t / 12.0 * from.acceleration_ned)};
}

}  // namespace swiftlet::control
