#include "swiftlet/services/px4/words.hpp"

#include <utility>

#include <fmt/core.h>

namespace swiftlet::px4 {
namespace {

constexpr const char* kModes[] = {
    "Manual",        "Altitude",    "Position",       "Mission",    "Hold",         "Return",
    "Position Slow", nullptr,       nullptr,          nullptr,      "Acro",         nullptr,
    "Descend",       "Termination", "Offboard",       "Stabilized", nullptr,        "Takeoff",
    "Land",          "Follow",      "Precision Land", "Orbit",      "VTOL Takeoff",
};
constexpr const char* kDisarmingReasons[] = {
    "transition to standby",
    "stick gesture",
    "RC switch",
    "internal command",
    "external command",
    "mission start",
    "safety button",
    "automatically after landing",
    "automatically before take-off",
    "kill switch",
    "lockdown",
    "failure detector",
    "shutdown",
    "unit test",
};
constexpr const char* kResults[] = {
    "accepted", "temporarily rejected", "denied", "unsupported", "failed", "in progress", "cancelled",
};
constexpr std::uint8_t kFirstExternalMode = 23;
constexpr std::uint8_t kLastExternalMode = 30;

template <std::size_t kSize>
std::string word(const char* const (&words)[kSize], std::uint8_t number, const char* kind) {
  if (number < kSize && words[number] != nullptr) return words[number];
  return fmt::format("{} {}", kind, number);
}

}  // namespace

std::string mode_name(std::uint8_t nav_state) {
  if (nav_state >= kFirstExternalMode && nav_state <= kLastExternalMode)
    return fmt::format("External {}", nav_state - kFirstExternalMode + 1);
  return word(kModes, nav_state, "number");
}

std::string disarming_reason(std::uint8_t reason) { return word(kDisarmingReasons, reason, "reason"); }

std::string result_text(std::uint8_t result) { return word(kResults, result, "result"); }

std::string failing_checks(const msg::FailsafeFlags& flags) {
  std::string text;
  const auto add = [&text](bool fails, const std::string& words) {
    if (fails) text += (text.empty() ? "" : ", ") + words;
  };
  for (const auto& [fails, words] : {
           std::pair{flags.angular_velocity_invalid(), "angular velocity invalid"},
           std::pair{flags.attitude_invalid(), "attitude invalid"},
           std::pair{flags.local_position_invalid(), "local position invalid"},
           std::pair{flags.local_velocity_invalid(), "local velocity invalid"},
           std::pair{flags.offboard_control_signal_lost(), "offboard signal lost"},
           std::pair{flags.battery_unhealthy(), "battery unhealthy"},
           std::pair{flags.battery_low_remaining_time(), "battery low"},
           std::pair{flags.geofence_breached(), "geofence breached"},
           std::pair{flags.fd_critical_failure(), "failure detector: critical"},
           std::pair{flags.fd_esc_arming_failure(), "failure detector: an ESC did not arm"},
           std::pair{flags.fd_imbalanced_prop(), "failure detector: imbalanced propeller"},
           std::pair{flags.fd_motor_failure(), "failure detector: motor"},
       })
    add(fails, words);
  if (flags.battery_warning() > 0) add(true, fmt::format("battery warning {}", flags.battery_warning()));
  return text;
}

}  // namespace swiftlet::px4
