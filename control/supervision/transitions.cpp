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
constexpr ModeSet kTunable{M::kDisarmed,   M::kArmed,    M::kHolding, M::kMission,
                           M::kTrajectory, M::kSetpoint, M::kStopped};
constexpr ModeSet kLeavingGround{M::kTakingOff, M::kMission};

// clang-format off
const Transition kTransitions[] = {
  // Conditions that stop the rotors at once.
  {kRotorsOn, E::kVehicleRestarted, guards::kAlways, preconditions::kNone, M::kStopped, R::kVehicleRestarted, actions::kNothing},
  {kRotorsOn, E::kImuUnusable, guards::kAlways, preconditions::kNone, M::kStopped, R::kImuUnusable, actions::kNothing},
  {kRotorsOn, E::kImuGap, guards::kAlways, preconditions::kNone, M::kStopped, R::kImuGap, actions::kNothing},
  {kRotorsOn, E::kTippedOver, guards::kAlways, preconditions::kNone, M::kStopped, R::kTippedOver, actions::kNothing},
  {kRotorsOn, E::kVehicleFault, guards::kAlways, preconditions::kNone, M::kStopped, R::kVehicleFault, actions::kNothing},
  {{M::kTakingOff, M::kHolding, M::kLanding}, E::kHoverTestFailed, guards::kInHoverTest, preconditions::kNone, M::kStopped, R::kHoverTestFailed, actions::kNothing},
  {kWithPosition, E::kTakeoffInconsistent, guards::kAlways, preconditions::kNone, M::kStopped, R::kTakeoffInconsistent, actions::kNothing},

  // A hard touchdown ends a descent or landing. In any other mode an impact is a collision.
  {{M::kDescent}, E::kImpact, guards::kAlways, preconditions::kNone, M::kDisarmed, R::kLandedWithoutPosition, actions::kNothing},
  {{M::kLanding}, E::kImpact, guards::kAlways, preconditions::kNone, M::kDisarmed, R::kLanded, actions::kNothing},
  {{M::kMission}, E::kImpact, guards::kOnLandingItem, preconditions::kNone, M::kDisarmed, R::kLanded, actions::kNothing},
  {kUnderWay, E::kImpact, guards::kAlways, preconditions::kNone, M::kStopped, R::kImpact, actions::kNothing},

  // Still on the ground: it stays there.
  {{M::kArmed}, E::kNotObeyed, guards::kAlways, preconditions::kNone, M::kDisarmed, R::kNotObeyed, actions::kNothing},
  {kLeavingGround, E::kNotObeyed, guards::kSpoolingUp, preconditions::kNone, M::kDisarmed, R::kNotObeyed, actions::kNothing},
  {kLeavingGround, E::kNoLiftOff, guards::kAlways, preconditions::kNone, M::kDisarmed, R::kNoLiftOff, actions::kNothing},
  {{M::kArmed}, E::kPoseLost, guards::kAlways, preconditions::kNone, M::kDisarmed, R::kNoPose, actions::kNothing},
  {{M::kArmed}, E::kGroundLinkLost, guards::kLinkMatters, preconditions::kNone, M::kDisarmed, R::kGroundLinkLost, actions::kNothing},
  {kLeavingGround, E::kRotorsNotRunning, guards::kSpoolingUp, preconditions::kNone, M::kDisarmed, R::kRotorsNotRunning, actions::kNothing},
  {kLeavingGround, E::kPoseLost, guards::kSpoolingUp, preconditions::kNone, M::kDisarmed, R::kNoPose, actions::kNothing},
  {kLeavingGround, E::kBatteryCritical, guards::kSpoolingUp, preconditions::kNone, M::kDisarmed, R::kBatteryCritical, actions::kNothing},
  {kLeavingGround, E::kOutsideFence, guards::kSpoolingUp, preconditions::kNone, M::kDisarmed, R::kOutsideFence, actions::kNothing},
  {kLeavingGround, E::kBatteryLow, guards::kSpoolingUp, preconditions::kNone, M::kDisarmed, R::kBatteryLow, actions::kNothing},
  {kLeavingGround, E::kBatterySilent, guards::kSpoolingUp, preconditions::kNone, M::kDisarmed, R::kBatterySilent, actions::kNothing},
  {kLeavingGround, E::kGroundLinkLost, guards::kLinkMattersOnGround, preconditions::kNone, M::kDisarmed, R::kGroundLinkLost, actions::kNothing},

  // The estimate was reset: the vehicle descends vertically, which is right whichever of the two was wrong.
  {{M::kArmed}, E::kPoseJumped, guards::kAlways, preconditions::kNone, M::kDisarmed, R::kPoseJumped, actions::kNothing},
  {kLeavingGround, E::kPoseJumped, guards::kSpoolingUp, preconditions::kNone, M::kDisarmed, R::kPoseJumped, actions::kNothing},
  {kUnderWay, E::kPoseJumped, guards::kAlways, preconditions::kNone, M::kLanding, R::kPoseJumped, actions::kLandFromEstimate},
  {{M::kDescent}, E::kPoseJumped, guards::kAlways, preconditions::kNone, M::kLanding, R::kPoseJumped, actions::kLandFromEstimate},
  {{M::kLanding}, E::kPoseJumped, guards::kAlways, preconditions::kNone, kStay, R::kPoseJumped, actions::kLandFromEstimate},

  // Without position.
  {{M::kLanding}, E::kPoseLost, guards::kAlways, preconditions::kNone, M::kDescent, R::kNoPose, actions::kLandOnReturn},
  {{M::kMission}, E::kPoseLost, guards::kOnLandingItem, preconditions::kNone, M::kDescent, R::kNoPose, actions::kLandOnReturn},
  {kUnderWay, E::kPoseLost, guards::kAlways, preconditions::kNone, M::kDescent, R::kNoPose, actions::kHoldOnReturn},
  {{M::kDescent}, E::kTouchdown, guards::kAlways, preconditions::kNone, M::kDisarmed, R::kLandedWithoutPosition, actions::kNothing},
  {{M::kDescent}, E::kPoseIsBack, guards::kWasLanding, preconditions::kNone, M::kLanding, R::kPoseIsBack, actions::kLandFromEstimate},
  {{M::kDescent}, E::kPoseIsBack, guards::kAlways, preconditions::kNone, M::kHolding, R::kPoseIsBack, actions::kStopFromEstimate},
  {{M::kDescent}, E::kDescentTimedOut, guards::kAlways, preconditions::kNone, M::kStopped, R::kDescentTimedOut, actions::kNothing},

  // Failsafes that end a flight.
  {kWithPosition, E::kBatteryCritical, guards::kNotHurrying, preconditions::kNone, M::kLanding, R::kBatteryCritical, actions::kLandFast},
  {kUnderWay, E::kOutsideFence, guards::kAlways, preconditions::kNone, M::kLanding, R::kOutsideFence, actions::kLandFromEstimate},
  {kUnderWay, E::kBatteryLow, guards::kAlways, preconditions::kNone, M::kLanding, R::kBatteryLow, actions::kLand},
  {kUnderWay, E::kBatterySilent, guards::kAlways, preconditions::kNone, M::kLanding, R::kBatterySilent, actions::kLand},
  {kUnderWay, E::kGroundLinkLost, guards::kLinkLands, preconditions::kNone, M::kLanding, R::kGroundLinkLost, actions::kLand},
  {kUnderWay, E::kGroundLinkLost, guards::kLinkHolds, preconditions::kNone, M::kHolding, R::kGroundLinkLost, actions::kStop},
  {{M::kSetpoint}, E::kSetpointsViolateFence, guards::kAlways, preconditions::kNone, M::kHolding, R::kSetpointsViolatedFence, actions::kStop},
  {{M::kSetpoint}, E::kSetpointsStopped, guards::kAlways, preconditions::kNone, M::kHolding, R::kSetpointsStopped, actions::kStop},

  // Normal end of a manoeuvre.
  {{M::kLanding, M::kMission}, E::kTouchdown, guards::kAlways, preconditions::kNone, M::kDisarmed, R::kLanded, actions::kNothing},
  {{M::kTakingOff}, E::kPlanFinished, guards::kAirborneInHoverTest, preconditions::kNone, M::kHolding, R::kHoverTest, actions::kNothing},
  {{M::kHolding}, E::kHoverTestPassed, guards::kInHoverTest, preconditions::kNone, M::kLanding, R::kHoverTestPassed, actions::kLand},
  {{M::kTakingOff}, E::kPlanFinished, guards::kAirborne, preconditions::kNone, M::kHolding, R::kTakeOffCompleted, actions::kNothing},
  {{M::kMission}, E::kPlanFinished, guards::kAlways, preconditions::kNone, M::kHolding, R::kMissionCompleted, actions::kNothing},
  {{M::kTrajectory}, E::kPlanFinished, guards::kAlways, preconditions::kNone, M::kHolding, R::kTrajectoryCompleted, actions::kNothing},

  // Requests.
  {kAny, E::kStop, guards::kAlways, preconditions::kNone, M::kStopped, R::kRequested, actions::kNothing},
  {{M::kDisarmed}, E::kArm, guards::kAlways, preconditions::kArming, M::kArmed, R::kRequested, actions::kNoteGround},
  {{M::kArmed}, E::kArm, guards::kAlways, preconditions::kNone, kStay, R::kRequested, actions::kNothing},
  {{M::kDisarmed, M::kArmed, M::kStopped}, E::kDisarm, guards::kAlways, preconditions::kNone, M::kDisarmed, R::kRequested, actions::kNothing},
  {kLeavingGround, E::kDisarm, guards::kSpoolingUp, preconditions::kNone, M::kDisarmed, R::kRequested, actions::kNothing},
  {{M::kArmed}, E::kTakeoff, guards::kAlways, preconditions::kTakeoff, M::kTakingOff, R::kRequested, actions::kTakeOff},
  {{M::kArmed}, E::kHoverTest, guards::kAlways, preconditions::kHoverTest, M::kTakingOff, R::kHoverTest, actions::kTakeOffToTest},
  {kAny, E::kMissionUpload, guards::kNoneUnderWay, preconditions::kUpload, kStay, R::kRequested, actions::kKeepMission},
  {{M::kArmed}, E::kMissionStart, guards::kAlways, preconditions::kStartFromGround, M::kMission, R::kRequested, actions::kStartMission},
  {{M::kHolding}, E::kMissionStart, guards::kNotPaused, preconditions::kStart, M::kMission, R::kRequested, actions::kStartMission},
  {{M::kMission}, E::kMissionPause, guards::kPausable, preconditions::kNamed, M::kHolding, R::kMissionPaused, actions::kPause},
  {{M::kHolding}, E::kMissionResume, guards::kPaused, preconditions::kNamed, M::kMission, R::kRequested, actions::kResume},
  {{M::kMission}, E::kMissionSkip, guards::kPausable, preconditions::kSkip, kStay, R::kRequested, actions::kSkip},
  {{M::kHolding}, E::kMissionSkip, guards::kPaused, preconditions::kSkip, M::kMission, R::kRequested, actions::kSkip},
  {kAny, E::kMissionClear, guards::kNoneFlown, preconditions::kClear, kStay, R::kRequested, actions::kClearMission},
  {{M::kHolding, M::kTrajectory, M::kSetpoint}, E::kTrajectory, guards::kAlways, preconditions::kTrajectory, M::kTrajectory, R::kRequested, actions::kStartTrajectory},
  {kTunable, E::kSettings, guards::kAlways, preconditions::kSettings, kStay, R::kRequested, actions::kChangeGains},
  {{M::kHolding}, E::kSetpoint, guards::kAlways, preconditions::kSetpoint, M::kSetpoint, R::kSetpointsCame, actions::kFollowSetpoint},
  {{M::kSetpoint}, E::kSetpoint, guards::kAlways, preconditions::kSetpoint, kStay, R::kSetpointsCame, actions::kFollowSetpoint},
  {kWithPosition, E::kGoTo, guards::kLiftedOff, preconditions::kGoTo, M::kHolding, R::kRequested, actions::kMove},
  {kWithPosition, E::kHold, guards::kLiftedOff, preconditions::kNone, M::kHolding, R::kRequested, actions::kStop},
  {kLeavingGround, E::kLand, guards::kSpoolingUp, preconditions::kNone, M::kDisarmed, R::kRequested, actions::kNothing},
  {{M::kLanding}, E::kLand, guards::kAlways, preconditions::kNone, kStay, R::kRequested, actions::kNothing},
  {{M::kDescent}, E::kLand, guards::kAlways, preconditions::kNone, kStay, R::kRequested, actions::kLandOnReturn},
  {kUnderWay, E::kLand, guards::kAlways, preconditions::kLand, M::kLanding, R::kRequested, actions::kLandAsAsked},
  {kLeavingGround, E::kPlanUnknown, guards::kSpoolingUp, preconditions::kNone, M::kDisarmed, R::kPlanUnknown, actions::kNothing},
  {{M::kHolding}, E::kPlanUnknown, guards::kPaused, preconditions::kNone, M::kHolding, R::kPlanUnknown, actions::kStop},
  {{M::kMission, M::kTrajectory}, E::kPlanUnknown, guards::kAlways, preconditions::kNone, M::kHolding, R::kPlanUnknown, actions::kStop},
  {{M::kDisarmed}, E::kEngagedInFlight, guards::kAlways, preconditions::kPose, M::kHolding, R::kEngagedInFlight, actions::kTakeIntoHold},
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

// Events that have a row in each mode: most steps have none of them.
const EventsByMode kAnswered = answered();

}  // namespace

TransitionTable transitions() { return {kTransitions, static_cast<int>(std::size(kTransitions))}; }

const Transition* find(const SupervisorContext& context, const EventSet& conditions) {
  if (!conditions.has_any_of(kAnswered[static_cast<std::size_t>(context.state.mode)])) return nullptr;
  for (const Transition& row : transitions()) {
    if (conditions.has(row.event) && row.from.has(context.state.mode) && row.guards.holds(context))
      return &row;
  }
  return nullptr;
}

const Transition* find(const SupervisorContext& context, Event request) {
  for (const Transition& row : transitions()) {
    if (row.event == request && row.from.has(context.state.mode) && row.guards.holds(context)) return &row;
  }
  return nullptr;
}

namespace {

Outcome refuse_for_mission(const SupervisorContext& context) {
  return refuse("mission %llu is %s", static_cast<unsigned long long>(context.state.guidance.mission.id),
                context.paused() ? "paused; resume or clear it" : "running; end it with hold, goto or land");
}

// Refuses pause, resume or skip of a mission that does not run, or cannot be interrupted now.
Outcome refuse_to_change_mission(Event request, const SupervisorContext& context) {
  if (context.state.mode != Mode::kMission && !context.paused()) return refuse("no mission is running");
  if (context.paused())
    return refuse("mission %llu is already paused",
                  static_cast<unsigned long long>(context.state.guidance.mission.id));
  if (context.state.guidance.phase == Phase::kSpoolUp) return refuse("the mission has not taken off yet");
  if (request == Event::kMissionResume) return refuse("the mission is not paused");
  return refuse("the mission is landing; end it with goto or hold");
}

}  // namespace

Outcome refusal(Event request, const SupervisorContext& context) {
  const Mode mode = context.state.mode;
  const char* const now = to_string(mode);
  const bool grounded = mode == Mode::kDisarmed || mode == Mode::kArmed;
  if (mode == Mode::kStopped && request != Event::kMissionUpload && request != Event::kMissionClear)
    return refuse("emergency stop is active; run `swiftlet disarm` first");
  switch (request) {
    case Event::kArm:
      return refuse("already in flight: %s", now);
    case Event::kDisarm:
      return refuse("cannot disarm while %s; land first, or run `swiftlet stop`", now);
    case Event::kTakeoff:
    case Event::kHoverTest:
      if (mode == Mode::kDisarmed) return refuse("not armed; run `swiftlet arm` first");
      if (mode == Mode::kLanding || mode == Mode::kDescent) return refuse("cannot take off while %s", now);
      if (mode == Mode::kTakingOff || context.state.guidance.phase == Phase::kSpoolUp)
        return refuse("already taking off");
      return refuse("already airborne; use goto");
    case Event::kLand:
      if (grounded) return refuse("already on the ground");
      return refuse("cannot land while %s", now);
    case Event::kMissionUpload:
    case Event::kMissionClear:
      return refuse_for_mission(context);
    case Event::kMissionStart:
      if (context.state.mode == Mode::kMission || context.paused()) return refuse_for_mission(context);
      if (mode == Mode::kDisarmed) return refuse("not armed; run `swiftlet arm` first");
      return refuse("cannot start a mission while %s", now);
    case Event::kMissionPause:
    case Event::kMissionResume:
    case Event::kMissionSkip:
      return refuse_to_change_mission(request, context);
    case Event::kTrajectory:
      if (grounded) return refuse("on the ground; take off first");
      return refuse("cannot start a trajectory while %s", now);
    case Event::kSettings:
      return refuse("cannot change the gains while %s", now);
    case Event::kSetpoint:
      return refuse("setpoints are not accepted while %s", now);
    default:
      if (grounded) return refuse("on the ground; take off first");
      return refuse("cannot do this while %s", now);
  }
}

}  // namespace swiftlet::control
