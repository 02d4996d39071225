// A mission as the control service flies it: a list of items in order, and the mission's own limits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

enum class MissionItemKind : std::uint8_t {
  kTakeoff = 0,     // climb vertically to position_ned.z from the present position
  kWaypoint = 1,    // fly straight to position_ned by minimum jerk, stop there and hold
  kLand = 2,        // descend vertically and stop the rotors
  kTrajectory = 3,  // join the first segment smoothly, fly all segments, then hold
  kWait = 4,        // hold the present position for hold_s
};
// By kind, as in the mission file.
constexpr const char* kMissionItemKinds[] = {"takeoff", "waypoint", "land", "trajectory", "wait"};
inline const char* to_string(MissionItemKind kind) {
  return kMissionItemKinds[static_cast<std::size_t>(kind)];
}

struct MissionItem {
  MissionItemKind kind = MissionItemKind::kWaypoint;
  Eigen::Vector3d position_ned =
      Eigen::Vector3d::Zero();      // m; kTakeoff uses z only, kTrajectory and kWait do not use it
  double yaw_rad = 0.0;             // kWaypoint: yaw at arrival
  bool yaw_free = true;             // true: keep the yaw of the reference and ignore that of the segments
  double speed = 0.5;               // m/s, peak speed (kTrajectory: of the move to its start), > 0
  double hold_s = 0.0;              // hold time after arrival, >= 0
  std::uint32_t first_segment = 0;  // kTrajectory: index into Mission::segments
  std::uint32_t segment_count = 0;  // kTrajectory: 1 or more
  double acceptance_radius_m =
      0.0;  // above 0: arrival also needs the estimate within this distance of the end
};

// The mission's own limits, in force while it runs or is paused. None is looser than the control settings.
struct MissionBounds {
  // > 0; 0: the limit of the settings
  double max_speed = 0.0;                                   // m/s
  double max_acceleration = 0.0;                            // m/s^2, of all references
  double max_jerk = 0.0;                                    // m/s^3, of all references
  double max_yaw_rate = 0.0;                                // rad/s, of all references
  bool fenced = false;                                      // false: the fence of the settings applies
  Eigen::Vector3d fence_min_ned = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d fence_max_ned = Eigen::Vector3d::Zero();
};

struct Mission {
  std::uint64_t id = 0;
  std::vector<MissionItem> items;
  std::vector<PolynomialSegment> segments;  // of all its trajectories; at most kMaxTrajectorySegments
  MissionBounds bounds;
};

constexpr int kMaxMissionItems = 2048;

// The same mission, `factor` times as slow, > 0: paths take longer, moves are flown at lower speeds. Holds and waits stay.
Mission stretched(Mission mission, double factor);

// The limits in force while a mission with these bounds is flown: the tighter value of each limit.
Limits tightened(const Limits& limits, const MissionBounds& bounds);

}  // namespace swiftlet::control
