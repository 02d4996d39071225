// The frames of positions and yaw angles in files, and their conversion to NED.
#pragma once

#include <cmath>

#include <Eigen/Core>

namespace swiftlet::ground {

// kNed: x north, y east, z down; yaw clockwise from north. kEnu: x east, y north, z up; yaw counter-clockwise
// from east.
enum class MissionFrame { kNed, kEnu };

// Of a position, velocity or acceleration.
inline Eigen::Vector3d ned_from(MissionFrame frame, const Eigen::Vector3d& vector) {
  return frame == MissionFrame::kNed ? vector : Eigen::Vector3d(vector.y(), vector.x(), -vector.z());
}

// Not wrapped: turns of a continuous yaw are kept.
inline double ned_yaw_from(MissionFrame frame, double yaw_rad) {
  return frame == MissionFrame::kNed ? yaw_rad : M_PI / 2 - yaw_rad;
}

}  // namespace swiftlet::ground
