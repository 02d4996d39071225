// A mission as the control service flies it: a list of items, one after another.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "control/trajectory/polynomial.hpp"

namespace swiftlet::control {

enum class MissionItemKind : std::uint8_t {
  kTakeoff = 0,     // climb straight up to position_ned.z, wherever the vehicle stands
  kWaypoint = 1,    // fly straight to position_ned and stop there, minimum jerk, then hold
  kLand = 2,        // descend straight down and stop the rotors
  kTrajectory = 3,  // join the first of its segments smoothly, fly them all, then hold
};

struct MissionItem {
  MissionItemKind kind = MissionItemKind::kWaypoint;
  Eigen::Vector3d position_ned =
      Eigen::Vector3d::Zero();      // m; of kTakeoff only z counts, of kTrajectory nothing
  double yaw_rad = 0.0;             // kWaypoint: yaw to be reached with the position
  bool yaw_free = true;             // true: keep the yaw that the reference has
  double speed = 0.5;               // m/s, the peak on the way (to the start of a trajectory), > 0
  double hold_s = 0.0;              // stay this long after arrival, >= 0
  std::uint32_t first_segment = 0;  // kTrajectory: index into Mission::segments
  std::uint32_t segment_count = 0;  // kTrajectory: 1 or more
};

struct Mission {
  std::uint64_t id = 0;
  std::vector<MissionItem> items;
  std::vector<PolynomialSegment> segments;  // of its trajectories; at most kMaxTrajectorySegments
};

constexpr int kMaxMissionItems = 2048;

}  // namespace swiftlet::control
