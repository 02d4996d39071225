// What a transition does besides changing the mode.
#pragma once

#include "swiftlet/control/supervision/supervisor_context.hpp"

namespace swiftlet::control {

struct Action {
  const char* text;
  void (*run)(SupervisorContext&);  // in the new mode
};

namespace actions {

extern const Action kNothing;
extern const Action kNoteGround;  // where it stands, is the ground
extern const Action kTakeOff;
extern const Action kKeepMission;
extern const Action kStartMission;
extern const Action kPause;
extern const Action kResume;
extern const Action kSkip;
extern const Action kClearMission;
extern const Action kStartTrajectory;
extern const Action kFollowSetpoint;
extern const Action kMove;
extern const Action kStop;
extern const Action kLandAsAsked;
extern const Action kLand;
extern const Action kLandFast;
extern const Action kHoldOnReturn;  // when the pose is back
extern const Action kLandOnReturn;
extern const Action kStopFromEstimate;  // the reference begins anew where the vehicle is
extern const Action kLandFromEstimate;
extern const Action kTakeIntoHold;

}  // namespace actions
}  // namespace swiftlet::control
