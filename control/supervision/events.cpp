#include "swiftlet/control/supervision/events.hpp"

namespace swiftlet::control {

const char* to_string(Event event) {
  switch (event) {
    case Event::kImuUnusable:
      return "IMU samples unusable";
    case Event::kImuGap:
      return "IMU samples were missing";
    case Event::kTippedOver:
      return "tipped over";
    case Event::kVehicleFault:
      return "vehicle fault";
    case Event::kRotorsNotRunning:
      return "rotors not running";
    case Event::kImpact:
      return "impact";
    case Event::kTakeoffInconsistent:
      return "take-off inconsistent";
    case Event::kPoseJumped:
      return "pose jumped";
    case Event::kPoseLost:
      return "pose lost";
    case Event::kPoseIsBack:
      return "pose available";
    case Event::kTouchdown:
      return "touchdown detected";
    case Event::kDescentTimedOut:
      return "descent timed out";
    case Event::kBatteryCritical:
      return "battery critical";
    case Event::kOutsideFence:
      return "outside the fence";
    case Event::kBatteryLow:
      return "battery low";
    case Event::kBatterySilent:
      return "battery silent";
    case Event::kGroundLinkLost:
      return "ground link lost";
    case Event::kSetpointsViolateFence:
      return "setpoints violate the fence";
    case Event::kSetpointsStopped:
      return "setpoints stopped";
    case Event::kPlanFinished:
      return "plan finished";
    case Event::kArm:
      return "arm";
    case Event::kDisarm:
      return "disarm";
    case Event::kTakeoff:
      return "takeoff";
    case Event::kMissionUpload:
      return "mission upload";
    case Event::kMissionStart:
      return "mission start";
    case Event::kMissionPause:
      return "mission pause";
    case Event::kMissionResume:
      return "mission resume";
    case Event::kMissionSkip:
      return "mission skip";
    case Event::kMissionClear:
      return "mission clear";
    case Event::kTrajectory:
      return "trajectory";
    case Event::kSetpoint:
      return "setpoint";
    case Event::kGoTo:
      return "goto";
    case Event::kHold:
      return "hold";
    case Event::kLand:
      return "land";
    case Event::kStop:
      return "stop";
    case Event::kSettings:
      return "set control";
    case Event::kPlanUnknown:
      return "plan unknown";
    case Event::kEngagedInFlight:
      return "engaged in flight";
  }
  return "unknown";
}

bool event_of(RequestKind kind, Event& event) {
  switch (kind) {
    case RequestKind::kArm:
      event = Event::kArm;
      return true;
    case RequestKind::kDisarm:
      event = Event::kDisarm;
      return true;
    case RequestKind::kTakeoff:
      event = Event::kTakeoff;
      return true;
    case RequestKind::kGoTo:
      event = Event::kGoTo;
      return true;
    case RequestKind::kHold:
      event = Event::kHold;
      return true;
    case RequestKind::kLand:
      event = Event::kLand;
      return true;
    case RequestKind::kStop:
      event = Event::kStop;
      return true;
    case RequestKind::kMissionStart:
      event = Event::kMissionStart;
      return true;
    case RequestKind::kMissionPause:
      event = Event::kMissionPause;
      return true;
    case RequestKind::kMissionResume:
      event = Event::kMissionResume;
      return true;
    case RequestKind::kMissionSkip:
      event = Event::kMissionSkip;
      return true;
    case RequestKind::kMissionClear:
      event = Event::kMissionClear;
      return true;
    case RequestKind::kMissionUpload:
      event = Event::kMissionUpload;
      return true;
    case RequestKind::kSettings:
      event = Event::kSettings;
      return true;
    case RequestKind::kTrajectory:
      event = Event::kTrajectory;
      return true;
  }
  return false;
}

std::optional<RequestKind> kind_of(Event event) {
  for (int number = 0; number <= static_cast<int>(RequestKind::kSettings); ++number) {
    const auto kind = static_cast<RequestKind>(number);
    Event of_kind{};
    if (event_of(kind, of_kind) && of_kind == event) return kind;
  }
  return std::nullopt;
}

}  // namespace swiftlet::control
