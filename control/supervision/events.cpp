#include "swiftlet/control/supervision/events.hpp"

#include <array>

namespace swiftlet::control {

namespace {

// In the order of Event.
constexpr std::array kEventNames = {
    "IMU samples unusable",
    "IMU samples were missing",
    "tipped over",
    "vehicle fault",
    "rotors not running",
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
    "plan finished",
    "arm",
    "disarm",
    "takeoff",
    "mission upload",
    "mission start",
    "mission pause",
    "mission resume",
    "mission skip",
    "mission clear",
    "trajectory",
    "setpoint",
    "goto",
    "hold",
    "land",
    "stop",
    "set control",
    "plan unknown",
    "engaged in flight",
};
static_assert(kEventNames.size() == kEventCount);

}  // namespace

const char* to_string(Event event) {
  const auto index = static_cast<std::size_t>(event);
  return index < kEventNames.size() ? kEventNames[index] : "unknown";
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
