// The action of a transition, besides the change of mode.
#pragma once

#include "swiftlet/control/supervision/supervisor_context.hpp"

namespace swiftlet::control {

struct Action {
  const char* text;
  void (*run)(SupervisorContext&);  // called in the new mode
};

namespace actions {

extern const Action kNothing;
extern const Action kNoteGround;  // the ground is at the estimated height
extern const Action kTakeOff;
extern const Action kTakeOffToTest;
extern const Action kKeepMission;
extern const Action kStartMission;
extern const Action kPause;
extern const Action kResume;
extern const Action kSkip;
extern const Action kClearMission;
extern const Action kStartTrajectory;
extern const Action kFollowSetpoint;
extern const Action kChangeGains;  // does nothing itself: FlightController owns the gains
extern const Action kMove;
extern const Action kStop;
extern const Action kLandAsAsked;
extern const Action kLand;
extern const Action kLandFast;
extern const Action kHoldOnReturn;  // once a pose is available
extern const Action kLandOnReturn;
extern const Action kStopFromEstimate;  // restarts the reference at the vehicle
extern const Action kLandFromEstimate;
extern const Action kTakeIntoHold;

}  // namespace actions
}  // namespace swiftlet::control
