// The guards and preconditions of the transition table. A guard selects whether a row applies. A
// precondition decides whether the request of that row is accepted, and if not, why.
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
extern const Guard kAirborne;
extern const Guard kInHoverTest;
extern const Guard kAirborneInHoverTest;
extern const Guard kSpoolingUp;  // in take-off, still on the ground: ends at lift-off where that is observed
extern const Guard kLiftedOff;   // the opposite
extern const Guard kOnLandingItem;
extern const Guard kPausable;  // in the climb or later, and not on the landing item
extern const Guard kPaused;    // a mission is paused
extern const Guard kNotPaused;
extern const Guard kNoneUnderWay;  // no mission is flown or paused
extern const Guard kNoneFlown;
extern const Guard kWasLanding;  // when the pose was lost
extern const Guard kNotHurrying;
extern const Guard kLinkHolds;    // failsafe.ground_link_action is hold
extern const Guard kLinkLands;    // ... is land
extern const Guard kLinkMatters;  // ... is hold or land
extern const Guard kLinkMattersOnGround;

}  // namespace guards

namespace preconditions {

extern const Precondition kNone;
extern const Precondition kArming;
extern const Precondition kTakeoff;
extern const Precondition kHoverTest;
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
extern const Precondition kSettings;

}  // namespace preconditions
}  // namespace swiftlet::control
