// Requests to the flight controller, setpoints, and the outcome of each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/polynomial.hpp"

namespace swiftlet::control {

enum class RequestKind : std::uint8_t {
  kArm = 0,
  kDisarm = 1,   // on the ground only
  kTakeoff = 2,  // to position_ned.z, straight up
  kGoTo = 3,     // to position_ned
  kHold = 4,     // brake to rest
  kLand = 5,
  kStop = 6,  // stop the rotors at once, in flight too
  kMissionStart = 7,
  kMissionPause = 8,   // brake along the path and keep the rest of the mission
  kMissionResume = 9,  // return to the point of the pause, then continue
  kMissionSkip = 10,   // continue with the next item
  kMissionClear = 11,  // delete the mission
  kHoverTest = 12,     // take off to 0.15 m, hover for 2 s and land, under tight limits
  // Sent by topics of their own, not by a command.
  kMissionUpload = 64,  // store the mission
  kTrajectory = 65,
  kSettings = 66,  // change the gains
};
const char* to_string(RequestKind kind);  // "goto", as the command of `swiftlet`

// Identifies a request: the client that sent it and the client's number for it.
struct RequestKey {
  std::uint64_t client = 0;
  std::uint64_t id = 0;  // 0: none

  bool operator==(const RequestKey& other) const { return client == other.client && id == other.id; }
};

struct GainChange;

struct Request {
  RequestKey key;
  RequestKind kind = RequestKind::kHold;
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m
  double yaw_rad = 0.0;
  bool yaw_free = true;          // true: keep the present yaw
  double speed = 0.5;            // m/s, peak
  std::uint64_t mission_id = 0;  // kMissionStart .. kMissionClear: the mission meant; 0: the uploaded one
  std::int64_t start_ns = 0;     // kMissionStart: when its first item begins; 0: at once
  const Mission* mission =
      nullptr;  // kMissionUpload; owned by the caller, kept until another upload is accepted
  const Trajectory* trajectory = nullptr;  // kTrajectory; likewise, or until the controller has left it
  // kSettings: from the gains in force to others, checked for stability; start_ns is ignored. Copied when the
  // request is accepted.
  const GainChange* gains = nullptr;
};

// Accepted, or refused with one sentence that names the value and the limit. A refused request changes
// nothing.
struct Outcome {
  bool accepted = false;
  char reason[192] = {};
};

// The quantity that a stream of setpoints commands.
enum class SetpointKind : std::uint8_t {
  kPosition = 0,  // with velocity and acceleration fed forward
  kVelocity = 1,  // with acceleration fed forward
  kAcceleration = 2,
  kAttitude = 3,   // and thrust; bypasses the position loop, as does kBodyRates
  kBodyRates = 4,  // and thrust
};
inline bool goes_past_position(SetpointKind kind) { return kind >= SetpointKind::kAttitude; }

// One setpoint of a stream. Fields that its kind does not name are ignored.
struct Setpoint {
  std::int64_t stamp_ns = 0;
  std::uint64_t sequence = 0;
  SetpointKind kind = SetpointKind::kPosition;
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();      // m
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();      // m/s
  Eigen::Vector3d acceleration_ned = Eigen::Vector3d::Zero();  // m/s^2
  bool yaw_free = false;  // kPosition to kAcceleration: true keeps the yaw, and turns it at yaw_rate
  double yaw_rad = 0.0;
  double yaw_rate = 0.0;                                               // rad/s
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();  // kAttitude
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();            // rad/s; kAttitude: fed forward
  double specific_thrust = 0.0;  // m/s^2 along -z of FRD: thrust over mass, 9.81 in hover
};

// What clients ask of one step: the newest setpoint, then requests in the order of their arrival. The step sets
// the outcomes.
struct ClientInputs {
  struct PendingRequest {
    const Request* request = nullptr;
    Outcome* outcome = nullptr;
  };
  static constexpr std::size_t kMaxRequests = 32;

  void add(const Request& request, Outcome& outcome) { requests.at(request_count++) = {&request, &outcome}; }

  const Setpoint* setpoint = nullptr;  // null: none
  Outcome setpoint_outcome;
  std::array<PendingRequest, kMaxRequests> requests{};
  std::size_t request_count = 0;
};

// Heartbeat of a ground client. depends: true switches the link-loss failsafe on for this client, false off.
struct GroundHeartbeat {
  std::uint64_t client = 0;  // not 0
  bool depends = false;
};

}  // namespace swiftlet::control
