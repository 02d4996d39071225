// What can be asked of the flight controller, and its answer.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "control/mission.hpp"
#include "control/trajectory/polynomial.hpp"

namespace swiftlet::control {

enum class RequestKind : std::uint8_t {
  kArm = 0,
  kDisarm = 1,   // on the ground only
  kTakeoff = 2,  // to position_ned.z above where it stands
  kGoTo = 3,     // to position_ned
  kHold = 4,     // stop where it is
  kLand = 5,
  kStop = 6,  // rotors off at once, wherever it is
  kMissionStart = 7,
  kMissionPause = 8,   // come to rest on the way, and keep the rest of it
  kMissionResume = 9,  // back to where it was left, and on
  kMissionSkip = 10,   // on with the next item
  kMissionClear = 11,  // forget it
  // Not by a command, but by messages of their own.
  kMissionUpload = 64,  // keep it, to be started
  kTrajectory = 65,
};

struct Request {
  RequestKind kind = RequestKind::kHold;
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m
  double yaw_rad = 0.0;
  bool yaw_free = true;          // keep the present yaw
  double speed = 0.5;            // m/s, peak
  std::uint64_t mission_id = 0;  // kMissionStart .. kMissionClear: of which mission; 0: whichever is there
  const Mission* mission =
      nullptr;  // kMissionUpload; owned by the caller, kept until another one is accepted
  const Trajectory* trajectory = nullptr;  // kTrajectory; likewise, or until the controller has left it
};

// Accepted, or refused with one sentence that names the value and the limit. Nothing of a refused request is
// applied.
struct Outcome {
  bool accepted = false;
  char reason[192] = {};
};

// One instant of a setpoint stream: fly to position_ned, with velocity and acceleration fed forward.
struct Setpoint {
  std::int64_t stamp_ns = 0;
  std::uint64_t sequence = 0;
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_ned = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
  double yaw_rate = 0.0;
};

// A sign of life of a ground tool. depends: from now on the flight depends on hearing it; false: no longer.
struct GroundSign {
  std::uint64_t client = 0;  // not 0
  bool depends = false;
};

}  // namespace swiftlet::control
