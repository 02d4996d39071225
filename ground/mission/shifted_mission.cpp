#include "swiftlet/ground/mission/shifted_mission.hpp"

namespace swiftlet::ground {

control::Mission shifted(control::Mission mission, const Eigen::Vector2d& by_ned,
                         const control::Limits& limits) {
  if (control::MissionBounds& bounds = mission.bounds; bounds.fenced) {
    bounds.fence_min_ned.head<2>() += by_ned;
    bounds.fence_max_ned.head<2>() += by_ned;
    bounds.fence_min_ned = bounds.fence_min_ned.cwiseMax(limits.fence_min_ned);
    bounds.fence_max_ned = bounds.fence_max_ned.cwiseMin(limits.fence_max_ned);
  }
  for (control::MissionItem& item : mission.items) item.position_ned.head<2>() += by_ned;
  for (control::PolynomialSegment& segment : mission.segments) {
    segment.x[0] += by_ned.x();
    segment.y[0] += by_ned.y();
  }
  return mission;
}

}  // namespace swiftlet::ground
