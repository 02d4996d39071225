#include "swiftlet/control/supervision/events.hpp"

#include <array>

namespace swiftlet::control {

namespace {

// In the order of Event.
constexpr std::array kConditionNames = {
    "vehicle restarted",
    "IMU samples unusable",
    "IMU samples were missing",
    "tipped over",
    "vehicle fault",
    "rotors not running",
    "not obeyed",
    "no lift-off",
    "hover test failed",
    "impact",
    "take-off inconsistent",
    "pose jumped",
    "pose lost",
    "pose available",
    "touchdown detected",
    "descent timed out",
    "battery critical",
    "outside the fence",
    "battery low",
    "battery silent",
    "ground link lost",
    "setpoints violate the fence",
    "setpoints stopped",
    "hover test passed",
    "plan finished",
};
static_assert(kConditionNames.size() == static_cast<std::size_t>(kFirstRequest));

struct OfRequest {
  RequestKind kind;
  Event event;
};
constexpr std::array kRequestEvents = {
    OfRequest{RequestKind::kArm, Event::kArm},
    OfRequest{RequestKind::kDisarm, Event::kDisarm},
    OfRequest{RequestKind::kTakeoff, Event::kTakeoff},
    OfRequest{RequestKind::kHoverTest, Event::kHoverTest},
    OfRequest{RequestKind::kGoTo, Event::kGoTo},
    OfRequest{RequestKind::kHold, Event::kHold},
    OfRequest{RequestKind::kLand, Event::kLand},
    OfRequest{RequestKind::kStop, Event::kStop},
    OfRequest{RequestKind::kMissionStart, Event::kMissionStart},
    OfRequest{RequestKind::kMissionPause, Event::kMissionPause},
    OfRequest{RequestKind::kMissionResume, Event::kMissionResume},
    OfRequest{RequestKind::kMissionSkip, Event::kMissionSkip},
    OfRequest{RequestKind::kMissionClear, Event::kMissionClear},
    OfRequest{RequestKind::kMissionUpload, Event::kMissionUpload},
    OfRequest{RequestKind::kTrajectory, Event::kTrajectory},
    OfRequest{RequestKind::kSettings, Event::kSettings},
};

}  // namespace

const char* to_string(Event event) {
  const auto index = static_cast<std::size_t>(event);
  if (index < kConditionNames.size()) return kConditionNames[index];
  if (const auto kind = kind_of(event)) return to_string(*kind);
  if (event == Event::kSetpoint) return "setpoint";
  if (event == Event::kPlanUnknown) return "plan unknown";
  return event == Event::kEngagedInFlight ? "engaged in flight" : "unknown";
}

bool event_of(RequestKind kind, Event& event) {
  for (const OfRequest& one : kRequestEvents) {
    if (one.kind != kind) continue;
    event = one.event;
    return true;
  }
  return false;
}

std::optional<RequestKind> kind_of(Event event) {
  for (const OfRequest& one : kRequestEvents) {
    if (one.event == event) return one.kind;
  }
  return std::nullopt;
}

}  // namespace swiftlet::control
