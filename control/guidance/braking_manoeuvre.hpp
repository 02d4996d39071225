// Brakes any motion to rest, with a free stopping point: along a quartic in position, whose cubic velocity
// goes smoothly to zero and whose acceleration ends at zero. Of all motions that come to rest in a given
// time, it has the least squared jerk.
#pragma once

#include "swiftlet/control/types/reference.hpp"

namespace swiftlet::control {

// join_to_rest() to place_ned in duration_s is this quartic.
struct BrakingManoeuvre {
  double duration_s = 0.0;                              // > 0
  Eigen::Vector3d place_ned = Eigen::Vector3d::Zero();  // m, the stopping point
};

// Braking with acceleration and jerk within their peaks (> 0), in min_duration_s (> 0) or more. A motion
// that starts with more than the peak acceleration is limited by its own acceleration instead, and the jerk
// limit grows in proportion. Closed form: the shortest for straight motions that do not brake yet, somewhat
// longer for others.
BrakingManoeuvre limited_braking(const Reference& from, double peak_acceleration, double peak_jerk,
                                 double min_duration_s);

}  // namespace swiftlet::control
