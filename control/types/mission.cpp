#include "swiftlet/control/types/mission.hpp"

#include <algorithm>

namespace swiftlet::control {
namespace {

void tighten(double& limit, double bound) {
  if (bound > 0.0) limit = std::min(limit, bound);
}

}  // namespace

Mission stretched(Mission mission, double factor) {
  for (MissionItem& item : mission.items) item.speed /= factor;
  for (PolynomialSegment& segment : mission.segments) segment = stretched(segment, factor);
  return mission;
}

Limits tightened(const Limits& limits, const MissionBounds& bounds) {
  Limits tight = limits;
  tighten(tight.max_speed, bounds.max_speed);
  tighten(tight.max_acceleration, bounds.max_acceleration);
  tighten(tight.max_reference_acceleration, bounds.max_acceleration);
  tighten(tight.max_reference_jerk, bounds.max_jerk);
  tighten(tight.max_yaw_rate, bounds.max_yaw_rate);
  if (!bounds.fenced) return tight;
  tight.fence_min_ned = limits.fence_min_ned.cwiseMax(bounds.fence_min_ned);
  tight.fence_max_ned = limits.fence_max_ned.cwiseMin(bounds.fence_max_ned);
  return tight;
}

}  // namespace swiftlet::control
