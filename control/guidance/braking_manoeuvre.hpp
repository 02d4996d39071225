// Coming to rest wherever that leads: the quartic along which the velocity, a cubic, goes from what it is to
// zero, and the acceleration with it. Of all ways to come to rest in a time it has the least jerk squared.
#pragma once

#include "swiftlet/control/types/reference.hpp"

namespace swiftlet::control {

// join_to_rest() to the place within the duration is the quartic.
struct BrakingManoeuvre {
  double duration_s = 0.0;                              // > 0
  Eigen::Vector3d place_ned = Eigen::Vector3d::Zero();  // m
};

// So that neither acceleration nor jerk are beyond their peaks (> 0), in min_duration_s (> 0) at least. A
// motion that begins with more acceleration than that keeps to what it begins with, and to as much more jerk.
// Closed form: the shortest where the motion is straight and does not brake yet, somewhat longer elsewhere.
BrakingManoeuvre limited_braking(const Reference& from, double peak_acceleration, double peak_jerk,
                                 double min_duration_s);

}  // namespace swiftlet::control
