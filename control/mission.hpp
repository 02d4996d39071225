// A mission as the control service flies it: a list of items, one after another.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace swiftlet::control {

enum class MissionItemKind : std::uint8_t {
  kTakeoff = 0,   // climb straight up to position_ned.z, wherever the vehicle stands
  kWaypoint = 1,  // fly straight to position_ned and stop there, minimum jerk, then hold
  kLand = 2,      // descend straight down and stop the rotors
};

struct MissionItem {
  MissionItemKind kind = MissionItemKind::kWaypoint;
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m; of kTakeoff only z counts
  double yaw_rad = 0.0;                                    // kWaypoint: yaw to be reached with the position
  bool yaw_free = true;                                    // true: keep the yaw that the reference has
  double speed = 0.5;                                      // m/s, the peak on the way, > 0
  double hold_s = 0.0;                                     // stay this long after arrival, >= 0
};

struct Mission {
  std::uint64_t id = 0;
  std::vector<MissionItem> items;
};

constexpr int kMaxMissionItems = 2048;

}  // namespace swiftlet::control
