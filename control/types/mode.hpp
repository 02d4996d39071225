// The flight modes and the status of the controller.
#pragma once

#include <array>
#include <cstdint>

#include "swiftlet/control/types/gains.hpp"
#include "swiftlet/plant/model/control_level.hpp"

namespace swiftlet::control {

enum class Mode : std::uint8_t {
  kDisarmed = 0,  // rotors off
  kArmed = 1,     // on the ground, rotors idle
  kTakingOff = 2,
  kHolding = 3,  // at a position, or moving to one
  kMission = 4,
  kTrajectory = 5,
  kSetpoint = 6,  // follows a setpoint stream
  kLanding = 7,
  kDescent = 8,  // level attitude without position, until touchdown or time-out
  kStopped = 9,  // rotors off by a request or a failsafe; disarm to leave
};
const char* to_string(Mode mode);
inline bool rotors_off(Mode mode) { return mode == Mode::kDisarmed || mode == Mode::kStopped; }

// Why a mode was entered. The numbers are those of REASON_* in ControlStatus.
enum class Reason : std::uint8_t {
  kStarted = 0,
  kRequested = 1,
  kTakeOffCompleted = 2,
  kMissionCompleted = 3,
  kTrajectoryCompleted = 4,
  kLanded = 5,
  kLandedWithoutPosition = 6,
  kSetpointsCame = 7,
  kSetpointsStopped = 8,
  kBatteryLow = 9,
  kBatteryCritical = 10,
  kBatterySilent = 11,
  kOutsideFence = 12,
  kNoPose = 13,
  kPoseIsBack = 14,
  kDescentTimedOut = 15,
  kTippedOver = 16,
  kImuUnusable = 17,
  kImuGap = 18,
  kGroundLinkLost = 19,
  kImpact = 20,  // the specific force exceeded failsafe.impact_m_s2: the vehicle hit the ground or a wall
  kTakeoffInconsistent = 21,  // poses do not follow the take-off: another body, or markers that came off
  kPoseJumped = 22,       // poses disagreed with the estimate for long, and the estimate was reset to them
  kPlanUnknown = 23,      // the mission or trajectory is not known here after a failover
  kEngagedInFlight = 24,  // the controller started while its vehicle was in the air
  kSetpointsViolatedFence = 25,  // a stream of attitudes or body rates violated the fence
  kMissionPaused = 26,
  kVehicleFault = 27,      // the vehicle reported a fault, such as that another flies it
  kRotorsNotRunning = 28,  // the vehicle did not report that its rotors run, and so did not take off
  kVehicleRestarted = 29,
  kNotObeyed = 30,  // the vehicle reported that it obeys no command of this controller
  kNoLiftOff = 31,
  kHoverTest = 32,        // takes off and holds for the hover test
  kHoverTestPassed = 33,  // and lands
  kHoverTestFailed = 34,  // Status::hover_test_defect says why
};
constexpr int kReasonCount = static_cast<int>(Reason::kHoverTestFailed) + 1;
const char* to_string(Reason reason);

// What the vehicle reports as fault: a sentence with its terminating 0; empty: none.
using VehicleFault = std::array<char, 128>;

enum class MissionState : std::uint8_t {
  kNone = 0,
  kRunning = 1,
  kCompleted = 2,  // can be started again, as can an aborted one
  kAborted = 3,
  kUploaded = 4,  // not started yet
  kPaused = 5,    // the vehicle holds
};
inline bool is_under_way(MissionState state) {
  return state == MissionState::kRunning || state == MissionState::kPaused;
}

struct MissionProgress {
  std::uint64_t id = 0;
  MissionState state = MissionState::kNone;
  int item_index = 0;  // item being flown, from 0
  int item_count = 0;
};

// The estimate that a vehicle brings of its own.
struct OdometryStatus {
  bool in_force = false;     // the vehicle is flown by it
  double distance_m = -1.0;  // from the estimate of motion capture; -1: one of both is missing
  double angle_rad = -1.0;   // likewise
  std::uint32_t resets = 0;  // jumps of it that were followed
};

struct Status {
  Mode mode = Mode::kDisarmed;
  Reason reason = Reason::kStarted;  // why the mode was entered
  bool has_pose = false;             // a mocap pose was accepted within the time-out
  double pose_age_s = 0.0;           // at this step
  bool airborne = false;
  int ground_links = 0;  // ground clients with the link-loss failsafe on
  double supply_voltage_v = 0.0;
  bool saturated = false;                                       // the rotors' limits cut the last command
  plant::ControlLevel level = plant::ControlLevel::kActuators;  // of the commands
  OdometryStatus odometry;
  MissionProgress mission;
  VehicleFault hover_test_defect{};  // of the last hover test; empty: none
  SettingsName settings{};           // name of the control settings in force, or that the gains change to
  double gains_progress = 1.0;       // 0 .. 1, of the change of gains
};

}  // namespace swiftlet::control
