// The events of the state machine: conditions, which are evaluated in every step, and requests.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/control/types/request.hpp"

namespace swiftlet::control {

enum class Event : std::uint8_t {
  // Conditions.
  kVehicleRestarted = 0,
  kImuUnusable,
  kImuGap,
  kTippedOver,
  kVehicleFault,
  kRotorsNotRunning,
  kNotObeyed,
  kNoLiftOff,
  kHoverTestFailed,
  kImpact,
  kTakeoffInconsistent,
  kPoseJumped,
  kPoseLost,
  kPoseIsBack,
  kTouchdown,
  kDescentTimedOut,
  kBatteryCritical,
  kOutsideFence,
  kBatteryLow,
  kBatterySilent,
  kGroundLinkLost,
  kSetpointsViolateFence,
  kSetpointsStopped,
  kHoverTestPassed,
  kPlanFinished,
  // Requests.
  kArm,
  kDisarm,
  kTakeoff,
  kHoverTest,
  kMissionUpload,
  kMissionStart,
  kMissionPause,
  kMissionResume,
  kMissionSkip,
  kMissionClear,
  kTrajectory,
  kSetpoint,
  kGoTo,
  kHold,
  kLand,
  kStop,
  kSettings,
  kPlanUnknown,      // the mission or trajectory is not known here after a failover
  kEngagedInFlight,  // the controller started while its vehicle was in the air
};
constexpr int kEventCount = static_cast<int>(Event::kEngagedInFlight) + 1;
constexpr Event kFirstRequest = Event::kArm;
inline bool is_request(Event event) { return event >= kFirstRequest; }

const char* to_string(Event event);  // "battery low", "goto"

// The event of a request. Returns false for a value that is no RequestKind.
bool event_of(RequestKind kind, Event& event);
// The reverse; nullopt for an event that is no request, and for setpoints.
std::optional<RequestKind> kind_of(Event event);

class EventSet {
 public:
  void add(Event event, bool happens) { bits_ |= static_cast<std::uint64_t>(happens) << index(event); }
  bool has(Event event) const { return (bits_ >> index(event) & 1U) != 0; }
  bool has_any_of(EventSet others) const { return (bits_ & others.bits_) != 0; }

 private:
  static unsigned index(Event event) { return static_cast<unsigned>(event); }
  std::uint64_t bits_ = 0;
};
static_assert(kEventCount <= 64);

}  // namespace swiftlet::control
