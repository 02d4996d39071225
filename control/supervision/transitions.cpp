#include "swiftlet/control/supervision/transitions.hpp"

#include <array>
#include <cstddef>
#include <iterator>

#include "swiftlet/control/planning/checks.hpp"

namespace swiftlet::control {
namespace {

using E = Event;
using M = Mode;
using R = Reason;

constexpr ModeSet kAny{M::kDisarmed,   M::kArmed,    M::kTakingOff, M::kHolding, M::kMission,
                       M::kTrajectory, M::kSetpoint, M::kLanding,   M::kDescent, M::kStopped};
constexpr ModeSet kRotorsOn{M::kArmed,      M::kTakingOff, M::kHolding, M::kMission,
                            M::kTrajectory, M::kSetpoint,  M::kLanding, M::kDescent};
constexpr ModeSet kWithPosition{M::kTakingOff,  M::kHolding,  M::kMission,
                                M::kTrajectory, M::kSetpoint, M::kLanding};
constexpr ModeSet kUnderWay{M::kTakingOff, M::kHolding, M::kMission, M::kTrajectory, M::kSetpoint};
constexpr ModeSet kLeavingGround{M::kTakingOff, M::kMission};

// clang-format off
const Transition kTransitions[] = {
  // What stops the rotors at once.
  {kRotorsOn, E::kImuUnusable, when::kAlways, check_of::kNone, M::kStopped, R::kImuUnusable, act::kNothing},
  {kRotorsOn, E::kImuGap, when::kAlways, check_of::kNone, M::kStopped, R::kImuGap, act::kNothing},
  {kRotorsOn, E::kTippedOver, when::kAlways, check_of::kNone, M::kStopped, R::kTippedOver, act::kNothing},
  {kWithPosition, E::kClimbNotSeen, when::kAlways, check_of::kNone, M::kStopped, R::kClimbNotSeen, act::kNothing},

  // A descent that ends hard has ended; any other flight has met the ground or a wall.
  {{M::kDescent}, E::kStruck, when::kAlways, check_of::kNone, M::kDisarmed, R::kLandedWithoutPosition, act::kNothing},
  {{M::kLanding}, E::kStruck, when::kAlways, check_of::kNone, M::kDisarmed, R::kLanded, act::kNothing},
  {{M::kMission}, E::kStruck, when::kOnLandingItem, check_of::kNone, M::kDisarmed, R::kLanded, act::kNothing},
  {kUnderWay, E::kStruck, when::kAlways, check_of::kNone, M::kStopped, R::kStruck, act::kNothing},

  // On the ground still, it stays there.
  {{M::kArmed}, E::kPoseLost, when::kAlways, check_of::kNone, M::kDisarmed, R::kNoPose, act::kNothing},
  {{M::kArmed}, E::kGroundLinkLost, when::kLinkMatters, check_of::kNone, M::kDisarmed, R::kGroundLinkLost, act::kNothing},
  {kLeavingGround, E::kPoseLost, when::kSpoolingUp, check_of::kNone, M::kDisarmed, R::kNoPose, act::kNothing},
  {kLeavingGround, E::kBatteryCritical, when::kSpoolingUp, check_of::kNone, M::kDisarmed, R::kBatteryCritical, act::kNothing},
  {kLeavingGround, E::kOutsideFence, when::kSpoolingUp, check_of::kNone, M::kDisarmed, R::kOutsideFence, act::kNothing},
  {kLeavingGround, E::kBatteryLow, when::kSpoolingUp, check_of::kNone, M::kDisarmed, R::kBatteryLow, act::kNothing},
  {kLeavingGround, E::kBatterySilent, when::kSpoolingUp, check_of::kNone, M::kDisarmed, R::kBatterySilent, act::kNothing},
  {kLeavingGround, E::kGroundLinkLost, when::kLinkMattersOnGround, check_of::kNone, M::kDisarmed, R::kGroundLinkLost, act::kNothing},

  // It is elsewhere than it was thought to be: straight down, whichever of the two was wrong.
  {{M::kArmed}, E::kPoseJumped, when::kAlways, check_of::kNone, M::kDisarmed, R::kPoseJumped, act::kNothing},
  {kLeavingGround, E::kPoseJumped, when::kSpoolingUp, check_of::kNone, M::kDisarmed, R::kPoseJumped, act::kNothing},
  {kUnderWay, E::kPoseJumped, when::kAlways, check_of::kNone, M::kLanding, R::kPoseJumped, act::kLandFromEstimate},
  {{M::kDescent}, E::kPoseJumped, when::kAlways, check_of::kNone, M::kLanding, R::kPoseJumped, act::kLandFromEstimate},
  {{M::kLanding}, E::kPoseJumped, when::kAlways, check_of::kNone, kStay, R::kPoseJumped, act::kLandFromEstimate},

  // Without position.
  {{M::kLanding}, E::kPoseLost, when::kAlways, check_of::kNone, M::kDescent, R::kNoPose, act::kLandOnReturn},
  {{M::kMission}, E::kPoseLost, when::kOnLandingItem, check_of::kNone, M::kDescent, R::kNoPose, act::kLandOnReturn},
  {kUnderWay, E::kPoseLost, when::kAlways, check_of::kNone, M::kDescent, R::kNoPose, act::kHoldOnReturn},
  {{M::kDescent}, E::kGroundFelt, when::kAlways, check_of::kNone, M::kDisarmed, R::kLandedWithoutPosition, act::kNothing},
  {{M::kDescent}, E::kPoseIsBack, when::kWasLanding, check_of::kNone, M::kLanding, R::kPoseIsBack, act::kLandFromEstimate},
  {{M::kDescent}, E::kPoseIsBack, when::kAlways, check_of::kNone, M::kHolding, R::kPoseIsBack, act::kStopFromEstimate},
  {{M::kDescent}, E::kDescentTimedOut, when::kAlways, check_of::kNone, M::kStopped, R::kDescentTimedOut, act::kNothing},

  // What ends a flight early.
  {kWithPosition, E::kBatteryCritical, when::kNotHurrying, check_of::kNone, M::kLanding, R::kBatteryCritical, act::kLandFast},
  {kUnderWay, E::kOutsideFence, when::kAlways, check_of::kNone, M::kLanding, R::kOutsideFence, act::kLandFromEstimate},
  {kUnderWay, E::kBatteryLow, when::kAlways, check_of::kNone, M::kLanding, R::kBatteryLow, act::kLand},
  {kUnderWay, E::kBatterySilent, when::kAlways, check_of::kNone, M::kLanding, R::kBatterySilent, act::kLand},
  {kUnderWay, E::kGroundLinkLost, when::kLinkLands, check_of::kNone, M::kLanding, R::kGroundLinkLost, act::kLand},
  {kUnderWay, E::kGroundLinkLost, when::kLinkHolds, check_of::kNone, M::kHolding, R::kGroundLinkLost, act::kStop},
  {{M::kSetpoint}, E::kSetpointsLeadOut, when::kAlways, check_of::kNone, M::kHolding, R::kSetpointsLedOut, act::kStop},
  {{M::kSetpoint}, E::kSetpointsStopped, when::kAlways, check_of::kNone, M::kHolding, R::kSetpointsStopped, act::kStop},

  // How a flight goes on.
  {{M::kLanding, M::kMission}, E::kGroundFelt, when::kAlways, check_of::kNone, M::kDisarmed, R::kLanded, act::kNothing},
  {{M::kTakingOff}, E::kPlanFinished, when::kAlways, check_of::kNone, M::kHolding, R::kTakeOffCompleted, act::kNothing},
  {{M::kMission}, E::kPlanFinished, when::kAlways, check_of::kNone, M::kHolding, R::kMissionCompleted, act::kNothing},
  {{M::kTrajectory}, E::kPlanFinished, when::kAlways, check_of::kNone, M::kHolding, R::kTrajectoryCompleted, act::kNothing},

  // Requests.
  {kAny, E::kStop, when::kAlways, check_of::kNone, M::kStopped, R::kRequested, act::kNothing},
  {{M::kDisarmed}, E::kArm, when::kAlways, check_of::kArming, M::kArmed, R::kRequested, act::kNoteGround},
  {{M::kArmed}, E::kArm, when::kAlways, check_of::kNone, kStay, R::kRequested, act::kNothing},
  {{M::kDisarmed, M::kArmed, M::kStopped}, E::kDisarm, when::kAlways, check_of::kNone, M::kDisarmed, R::kRequested, act::kNothing},
  {kLeavingGround, E::kDisarm, when::kSpoolingUp, check_of::kNone, M::kDisarmed, R::kRequested, act::kNothing},
  {{M::kArmed}, E::kTakeoff, when::kAlways, check_of::kTakeoff, M::kTakingOff, R::kRequested, act::kTakeOff},
  {kAny, E::kMissionUpload, when::kNoneUnderWay, check_of::kUpload, kStay, R::kRequested, act::kKeepMission},
  {{M::kArmed}, E::kMissionStart, when::kAlways, check_of::kStartFromGround, M::kMission, R::kRequested, act::kStartMission},
  {{M::kHolding}, E::kMissionStart, when::kNotPaused, check_of::kStart, M::kMission, R::kRequested, act::kStartMission},
  {{M::kMission}, E::kMissionPause, when::kPausable, check_of::kNamed, M::kHolding, R::kMissionPaused, act::kPause},
  {{M::kHolding}, E::kMissionResume, when::kPaused, check_of::kNamed, M::kMission, R::kRequested, act::kResume},
  {{M::kMission}, E::kMissionSkip, when::kPausable, check_of::kSkip, kStay, R::kRequested, act::kSkip},
  {{M::kHolding}, E::kMissionSkip, when::kPaused, check_of::kSkip, M::kMission, R::kRequested, act::kSkip},
  {kAny, E::kMissionClear, when::kNoneFlown, check_of::kClear, kStay, R::kRequested, act::kClearMission},
  {{M::kHolding, M::kTrajectory, M::kSetpoint}, E::kTrajectory, when::kAlways, check_of::kTrajectory, M::kTrajectory, R::kRequested, act::kStartTrajectory},
  {{M::kHolding}, E::kSetpoint, when::kAlways, check_of::kSetpoint, M::kSetpoint, R::kSetpointsCame, act::kFollowSetpoint},
  {{M::kSetpoint}, E::kSetpoint, when::kAlways, check_of::kSetpoint, kStay, R::kSetpointsCame, act::kFollowSetpoint},
  {kWithPosition, E::kGoTo, when::kLiftedOff, check_of::kGoTo, M::kHolding, R::kRequested, act::kMove},
  {kWithPosition, E::kHold, when::kLiftedOff, check_of::kNone, M::kHolding, R::kRequested, act::kStop},
  {kLeavingGround, E::kLand, when::kSpoolingUp, check_of::kNone, M::kDisarmed, R::kRequested, act::kNothing},
  {{M::kLanding}, E::kLand, when::kAlways, check_of::kNone, kStay, R::kRequested, act::kNothing},
  {{M::kDescent}, E::kLand, when::kAlways, check_of::kNone, kStay, R::kRequested, act::kLandOnReturn},
  {kUnderWay, E::kLand, when::kAlways, check_of::kLand, M::kLanding, R::kRequested, act::kLandAsAsked},
  {kLeavingGround, E::kPlanUnknown, when::kSpoolingUp, check_of::kNone, M::kDisarmed, R::kPlanUnknown, act::kNothing},
  {{M::kHolding}, E::kPlanUnknown, when::kPaused, check_of::kNone, M::kHolding, R::kPlanUnknown, act::kStop},
  {{M::kMission, M::kTrajectory}, E::kPlanUnknown, when::kAlways, check_of::kNone, M::kHolding, R::kPlanUnknown, act::kStop},
  {{M::kDisarmed}, E::kFoundFlying, when::kAlways, check_of::kPose, M::kHolding, R::kFoundFlying, act::kTakeIntoHold},
};
// clang-format on

using EventsByMode = std::array<EventSet, kModeCount>;

EventsByMode answered() {
  EventsByMode events;
  for (int i = 0; i < kModeCount; ++i) {
    for (const Transition& row : kTransitions)
      events[static_cast<std::size_t>(i)].add(row.event, row.from.has(static_cast<Mode>(i)));
  }
  return events;
}

// For which events there is a row in the mode: hardly a step sees one of them.
const EventsByMode kAnswered = answered();

}  // namespace

TransitionTable transitions() { return {kTransitions, static_cast<int>(std::size(kTransitions))}; }

const Transition* find(const Scene& scene, const EventSet& conditions) {
  if (!conditions.has_any_of(kAnswered[static_cast<std::size_t>(scene.state.mode)])) return nullptr;
  for (const Transition& row : transitions()) {
    if (conditions.has(row.event) && row.from.has(scene.state.mode) && row.when.holds(scene)) return &row;
  }
  return nullptr;
}

const Transition* find(const Scene& scene, Event request) {
  for (const Transition& row : transitions()) {
    if (row.event == request && row.from.has(scene.state.mode) && row.when.holds(scene)) return &row;
  }
  return nullptr;
}

namespace {

Outcome refuse_for_mission(const Scene& scene) {
  return refuse("mission %llu is %s", static_cast<unsigned long long>(scene.state.guidance.mission.id),
                scene.paused() ? "paused: resume or clear it" : "being flown: hold, goto or land ends that");
}

// Of what is asked of a mission that is not being flown, or must not be interrupted where it is.
Outcome refuse_to_change_mission(Event request, const Scene& scene) {
  if (scene.state.mode != Mode::kMission && !scene.paused()) return refuse("no mission is being flown");
  if (scene.paused())
    return refuse("mission %llu is paused already",
                  static_cast<unsigned long long>(scene.state.guidance.mission.id));
  if (scene.state.guidance.phase == Phase::kSpoolUp) return refuse("the mission's take-off has only begun");
  if (request == Event::kMissionResume) return refuse("the mission is not paused");
  return refuse("the mission is at its landing; goto or hold ends that");
}

}  // namespace

Outcome refusal(Event request, const Scene& scene) {
  const char* const now = to_string(scene.state.mode);
  switch (request) {
    case Event::kArm:
      return refuse("cannot arm while %s", now);
    case Event::kDisarm:
      return refuse("cannot disarm while %s; land first, or stop", now);
    case Event::kTakeoff:
      return refuse("cannot take off while %s; arm first", now);
    case Event::kMissionUpload:
    case Event::kMissionClear:
      return refuse_for_mission(scene);
    case Event::kMissionStart:
      if (scene.state.mode == Mode::kMission || scene.paused()) return refuse_for_mission(scene);
      return refuse("cannot start a mission while %s%s", now,
                    scene.state.mode == Mode::kDisarmed ? "; arm first" : "");
    case Event::kMissionPause:
    case Event::kMissionResume:
    case Event::kMissionSkip:
      return refuse_to_change_mission(request, scene);
    case Event::kTrajectory:
      return refuse("cannot start a trajectory while %s", now);
    case Event::kSetpoint:
      return refuse("setpoints are not followed while %s", now);
    default:
      return refuse("cannot do that while %s", now);
  }
}

}  // namespace swiftlet::control
