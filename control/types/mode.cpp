#include "swiftlet/control/types/mode.hpp"

namespace swiftlet::control {
namespace {

// In the order of Reason.
constexpr std::array kReasonNames = {
    "started",
    "requested",
    "take-off completed",
    "mission completed",
    "trajectory completed",
    "landed",
    "landed without position",
    "setpoints received",
    "setpoints stopped",
    "battery is low",
    "battery is critical",
    "no battery voltage",
    "outside the fence",
    "no mocap pose",
    "pose regained",
    "descent without position timed out",
    "tipped over",
    "IMU samples are not usable",
    "IMU samples were missing",
    "ground link lost",
    "impact detected",
    "poses do not follow the take-off",
    "position jumped",
    "mission or trajectory unknown after failover",
    "engaged in flight",
    "setpoints violated the fence",
    "mission paused",
    "the vehicle reports a fault",
    "the vehicle does not report rotors_running in vehicle_info",
    "the vehicle was restarted",
    "the vehicle does not obey control's commands",
    "the vehicle did not leave the ground",
    "hover test",
    "hover test passed",
    "hover test failed",
};
static_assert(kReasonNames.size() == kReasonCount);

}  // namespace

const char* to_string(Mode mode) {
  switch (mode) {
    case Mode::kDisarmed:
      return "disarmed";
    case Mode::kArmed:
      return "armed";
    case Mode::kTakingOff:
      return "taking off";
    case Mode::kHolding:
      return "holding";
    case Mode::kMission:
      return "mission";
    case Mode::kTrajectory:
      return "trajectory";
    case Mode::kSetpoint:
      return "setpoint";
    case Mode::kLanding:
      return "landing";
    case Mode::kDescent:
      return "descent";
    case Mode::kStopped:
      return "stopped";
  }
  return "unknown";
}

const char* to_string(Reason reason) {
  const auto index = static_cast<std::size_t>(reason);
  return index < kReasonNames.size() ? kReasonNames[index] : "unknown";
}

}  // namespace swiftlet::control
