// The guards of the transition table. A selector decides whether a row is the one; a check, whether what its
// request asks is allowed, and if not, why.
#pragma once

#include "swiftlet/control/supervision/supervisor_context.hpp"

namespace swiftlet::control {

struct Guard {
  const char* text;
  bool (*holds)(const SupervisorContext&);
};

struct Precondition {
  const char* text;
  Outcome (*evaluate)(const SupervisorContext&);
};

namespace guards {

extern const Guard kAlways;
extern const Guard kSpoolingUp;  // on the ground still, in take-off
extern const Guard kLiftedOff;   // not so
extern const Guard kOnLandingItem;
extern const Guard kPausable;  // lifted off, and not at the mission's landing
extern const Guard kPaused;    // a mission is
extern const Guard kNotPaused;
extern const Guard kNoneUnderWay;  // no mission is flown or paused
extern const Guard kNoneFlown;
extern const Guard kWasLanding;  // when the pose was lost
extern const Guard kNotHurrying;
extern const Guard kLinkHolds;    // failsafe.ground_link_action is hold
extern const Guard kLinkLands;    // land
extern const Guard kLinkMatters;  // either
extern const Guard kLinkMattersOnGround;

}  // namespace guards

namespace preconditions {

extern const Precondition kNone;
extern const Precondition kArming;
extern const Precondition kTakeoff;
extern const Precondition kUpload;
extern const Precondition kStartFromGround;
extern const Precondition kStart;
extern const Precondition kNamed;
extern const Precondition kSkip;
extern const Precondition kClear;
extern const Precondition kTrajectory;
extern const Precondition kSetpoint;
extern const Precondition kGoTo;
extern const Precondition kLand;
extern const Precondition kPose;

}  // namespace preconditions
}  // namespace swiftlet::control
