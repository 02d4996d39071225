// The states of flight and what the controller says of itself.
#pragma once

#include <cstdint>

namespace swiftlet::control {

enum class Mode : std::uint8_t {
  kDisarmed = 0,  // rotors off
  kArmed = 1,     // on the ground, rotors turning slowly
  kTakingOff = 2,
  kHolding = 3,  // at a place, or on the way to one
  kMission = 4,
  kTrajectory = 5,
  kSetpoint = 6,  // follows a setpoint stream
  kLanding = 7,
  kDescent = 8,  // level, without position, until the ground or a time-out
  kStopped = 9,  // rotors off by a request or a failsafe; disarm to leave
};
const char* to_string(Mode mode);
inline bool rotors_off(Mode mode) { return mode == Mode::kDisarmed || mode == Mode::kStopped; }

// Why a mode was entered.
enum class Reason : std::uint8_t {
  kStarted = 0,
  kRequested,
  kTakeOffCompleted,
  kMissionCompleted,
  kTrajectoryCompleted,
  kLanded,
  kLandedWithoutPosition,
  kSetpointsCame,
  kSetpointsStopped,
  kBatteryLow,
  kBatteryCritical,
  kBatterySilent,
  kOutsideFence,
  kNoPose,
  kPoseIsBack,
  kDescentTimedOut,
  kTippedOver,
  kImuUnusable,
  kImuGap,
  kGroundLinkLost,
  kImpact,               // the accelerometer felt a blow as of a fall to the ground
  kTakeoffInconsistent,  // motion capture did not follow the take-off: another body, or markers that came off
  kPoseJumped,           // motion capture says for long that the vehicle is elsewhere
  kPlanUnknown,      // another controller was taken over from whose mission or trajectory is not known here
  kEngagedInFlight,  // the controller was started while its vehicle flew
  kSetpointsViolatedFence,  // a stream of attitudes or body rates led out of the fence
  kMissionPaused,
};
constexpr int kReasonCount = static_cast<int>(Reason::kMissionPaused) + 1;
const char* to_string(Reason reason);

enum class MissionState : std::uint8_t {
  kNone = 0,
  kRunning = 1,
  kCompleted = 2,  // it can be started again, as one that was aborted
  kAborted = 3,
  kUploaded = 4,  // not started yet
  kPaused = 5,    // its vehicle holds
};
inline bool is_under_way(MissionState state) {
  return state == MissionState::kRunning || state == MissionState::kPaused;
}

struct MissionProgress {
  std::uint64_t id = 0;
  MissionState state = MissionState::kNone;
  int item_index = 0;  // the item being flown, from 0
  int item_count = 0;
};

struct Status {
  Mode mode = Mode::kDisarmed;
  Reason reason = Reason::kStarted;  // why the mode was entered
  bool has_pose = false;             // a mocap pose has come within the time-out
  double pose_age_s = 0.0;           // at this step
  bool airborne = false;
  int ground_links = 0;  // ground tools that the flight depends on
  double supply_voltage_v = 0.0;
  bool saturated = false;  // the last command was cut by the rotors' limits
  MissionProgress mission;
};

}  // namespace swiftlet::control
