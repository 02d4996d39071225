#include "swiftlet/control/types/mode.hpp"

namespace swiftlet::control {

const char* to_string(Mode mode) {
  switch (mode) {
    case Mode::kDisarmed:
      return "disarmed";
    case Mode::kArmed:
      return "armed";
    case Mode::kTakingOff:
      return "taking off";
    case Mode::kHolding:
      return "holding";
    case Mode::kMission:
      return "mission";
    case Mode::kTrajectory:
      return "trajectory";
    case Mode::kSetpoint:
      return "setpoint";
    case Mode::kLanding:
      return "landing";
    case Mode::kDescent:
      return "descent";
    case Mode::kStopped:
      return "stopped";
  }
  return "unknown";
}

const char* to_string(Reason reason) {
  switch (reason) {
    case Reason::kStarted:
      return "started";
    case Reason::kRequested:
      return "requested";
    case Reason::kTakeOffCompleted:
      return "take-off completed";
    case Reason::kMissionCompleted:
      return "mission completed";
    case Reason::kTrajectoryCompleted:
      return "trajectory completed";
    case Reason::kLanded:
      return "landed";
    case Reason::kLandedWithoutPosition:
      return "landed without position";
    case Reason::kSetpointsCame:
      return "setpoints received";
    case Reason::kSetpointsStopped:
      return "setpoints stopped";
    case Reason::kBatteryLow:
      return "battery is low";
    case Reason::kBatteryCritical:
      return "battery is critical";
    case Reason::kBatterySilent:
      return "no battery voltage";
    case Reason::kOutsideFence:
      return "outside the fence";
    case Reason::kNoPose:
      return "no mocap pose";
    case Reason::kPoseIsBack:
      return "pose regained";
    case Reason::kDescentTimedOut:
      return "descent without position timed out";
    case Reason::kTippedOver:
      return "tipped over";
    case Reason::kImuUnusable:
      return "IMU samples are not usable";
    case Reason::kImuGap:
      return "IMU samples were missing";
    case Reason::kGroundLinkLost:
      return "ground link lost";
    case Reason::kImpact:
      return "impact detected";
    case Reason::kTakeoffInconsistent:
      return "poses do not follow the take-off";
    case Reason::kPoseJumped:
      return "position jumped";
    case Reason::kPlanUnknown:
      return "mission or trajectory unknown after failover";
    case Reason::kEngagedInFlight:
      return "engaged in flight";
    case Reason::kSetpointsViolatedFence:
      return "setpoints violated the fence";
    case Reason::kMissionPaused:
      return "mission paused";
    case Reason::kVehicleFault:
      return "the vehicle reports a fault";
    case Reason::kRotorsNotRunning:
      return "the vehicle does not report rotors_running in vehicle_info";
  }
  return "unknown";
}

}  // namespace swiftlet::control
