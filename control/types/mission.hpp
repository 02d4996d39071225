// A mission as the control service flies it: a list of items, one after another, and the bounds that it
// sets itself.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

enum class MissionItemKind : std::uint8_t {
  kTakeoff = 0,     // climb straight up to position_ned.z, wherever the vehicle stands
  kWaypoint = 1,    // fly straight to position_ned and stop there, minimum jerk, then hold
  kLand = 2,        // descend straight down and stop the rotors
  kTrajectory = 3,  // join the first of its segments smoothly, fly them all, then hold
  kWait = 4,        // stay where it is for hold_s
};

struct MissionItem {
  MissionItemKind kind = MissionItemKind::kWaypoint;
  Eigen::Vector3d position_ned =
      Eigen::Vector3d::Zero();      // m; of kTakeoff only z counts, of kTrajectory and kWait nothing
  double yaw_rad = 0.0;             // kWaypoint: yaw to be reached with the position
  bool yaw_free = true;             // true: keep the yaw that the reference has, whatever the segments' is
  double speed = 0.5;               // m/s, the peak on the way (to the start of a trajectory), > 0
  double hold_s = 0.0;              // stay this long after arrival, >= 0
  std::uint32_t first_segment = 0;  // kTrajectory: index into Mission::segments
  std::uint32_t segment_count = 0;  // kTrajectory: 1 or more
  double acceptance_radius_m =
      0.0;  // above 0: arrived is who is this near by the estimate, not the reference alone
};

// What a mission allows itself while it is flown or paused, at most what the control settings allow.
struct MissionBounds {
  // > 0; 0: as in the settings.
  double max_speed = 0.0;                                   // m/s
  double max_acceleration = 0.0;                            // m/s^2, of all references
  double max_jerk = 0.0;                                    // m/s^3, likewise
  double max_yaw_rate = 0.0;                                // rad/s, likewise
  bool fenced = false;                                      // else the fence of the settings holds
  Eigen::Vector3d fence_min_ned = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d fence_max_ned = Eigen::Vector3d::Zero();
};

struct Mission {
  std::uint64_t id = 0;
  std::vector<MissionItem> items;
  std::vector<PolynomialSegment> segments;  // of its trajectories; at most kMaxTrajectorySegments
  MissionBounds bounds;
};

constexpr int kMaxMissionItems = 2048;

// What holds while a mission with these bounds is flown: of each limit the tighter one.
Limits tightened(const Limits& limits, const MissionBounds& bounds);

}  // namespace swiftlet::control
