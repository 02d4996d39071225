// What can be asked of the flight controller, and its answer.
#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/polynomial.hpp"

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

// A request, by who asked and the number that it was given there.
struct RequestKey {
  std::uint64_t client = 0;
  std::uint64_t id = 0;  // 0: none

  bool operator==(const RequestKey& other) const { return client == other.client && id == other.id; }
};

struct Request {
  RequestKey key;
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

// What a stream of setpoints commands.
enum class SetpointKind : std::uint8_t {
  kPosition = 0,  // with velocity and acceleration fed forward
  kVelocity = 1,  // with acceleration fed forward
  kAcceleration = 2,
  kAttitude = 3,   // and thrust; past the position loop, as what follows
  kBodyRates = 4,  // and thrust
};
inline bool goes_past_position(SetpointKind kind) { return kind >= SetpointKind::kAttitude; }

// One instant of a stream. What its kind does not name is not looked at.
struct Setpoint {
  std::int64_t stamp_ns = 0;
  std::uint64_t sequence = 0;
  SetpointKind kind = SetpointKind::kPosition;
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();      // m
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();      // m/s
  Eigen::Vector3d acceleration_ned = Eigen::Vector3d::Zero();  // m/s^2
  bool yaw_free = false;  // kPosition to kAcceleration: true keeps the heading, and turns it at yaw_rate
  double yaw_rad = 0.0;
  double yaw_rate = 0.0;                                               // rad/s
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();  // kAttitude
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();            // rad/s; of kAttitude fed forward
  double specific_thrust = 0.0;  // m/s^2 along -z of FRD: force over mass, 9.81 carries the weight
};

// A sign of life of a ground tool. depends: from now on the flight depends on hearing it; false: no longer.
struct GroundHeartbeat {
  std::uint64_t client = 0;  // not 0
  bool depends = false;
};

}  // namespace swiftlet::control
