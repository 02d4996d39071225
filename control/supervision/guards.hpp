// The guards of the transition table. A selector decides whether a row is the one; a check, whether what its
// request asks is allowed, and if not, why.
#pragma once

#include "swiftlet/control/supervision/scene.hpp"

namespace swiftlet::control {

struct Selector {
  const char* text;
  bool (*holds)(const Scene&);
};

struct Check {
  const char* text;
  Outcome (*judge)(const Scene&);
};

namespace when {

extern const Selector kAlways;
extern const Selector kSpoolingUp;  // on the ground still, in take-off
extern const Selector kLiftedOff;   // not so
extern const Selector kOnLandingItem;
extern const Selector kPausable;  // lifted off, and not at the mission's landing
extern const Selector kPaused;    // a mission is
extern const Selector kNotPaused;
extern const Selector kNoneUnderWay;  // no mission is flown or paused
extern const Selector kNoneFlown;
extern const Selector kWasLanding;  // when the pose was lost
extern const Selector kNotHurrying;
extern const Selector kLinkHolds;    // failsafe.ground_link_action is hold
extern const Selector kLinkLands;    // land
extern const Selector kLinkMatters;  // either
extern const Selector kLinkMattersOnGround;

}  // namespace when

namespace check_of {

extern const Check kNone;
extern const Check kArming;
extern const Check kTakeoff;
extern const Check kUpload;
extern const Check kStartFromGround;
extern const Check kStart;
extern const Check kNamed;
extern const Check kSkip;
extern const Check kClear;
extern const Check kTrajectory;
extern const Check kSetpoint;
extern const Check kGoTo;
extern const Check kLand;
extern const Check kPose;

}  // namespace check_of
}  // namespace swiftlet::control
