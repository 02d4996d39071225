#include "swiftlet/plant/simulation/actuator_watchdog.hpp"

namespace swiftlet::plant {

const char* to_string(CommandFault fault) {
  switch (fault) {
    case CommandFault::kNone:
      return "no fault";
    case CommandFault::kRotorCount:
      return "rotor count differs from the vehicle's";
    case CommandFault::kRotorState:
      return "rotor state is neither off nor running";
    case CommandFault::kThrottle:
      return "throttle is not a number within 0 .. 1";
    case CommandFault::kStale:
      return "answers an outdated IMU sample";
    case CommandFault::kFuture:
      return "answers an IMU sample of the future";
    case CommandFault::kOvertaken:
      return "a controller with a higher term has taken over";
  }
  return "";
}

ActuatorWatchdog::ActuatorWatchdog(int rotor_count, std::int64_t timeout_ns)
    : rotor_count_(rotor_count), timeout_ns_(timeout_ns) {}

CommandFault ActuatorWatchdog::accept(const ActuatorCommand& command, std::int64_t now_ns) {
  if (command.rotor_count != rotor_count_) return CommandFault::kRotorCount;
  if (command.rotor_state != RotorState::kOff && command.rotor_state != RotorState::kRunning) {
    return CommandFault::kRotorState;
  }
  const auto count = static_cast<std::size_t>(rotor_count_);
  for (std::size_t i = 0; i < count; ++i) {
    if (!(command.throttle[i] >= 0.0 && command.throttle[i] <= 1.0)) return CommandFault::kThrottle;
  }
  if (command.stamp_ns > now_ns) return CommandFault::kFuture;
  if (last_stamp_ns_ && command.stamp_ns < *last_stamp_ns_) return CommandFault::kStale;
  if (command.stamp_ns < now_ns - timeout_ns_) return CommandFault::kStale;
  if (command.term < term_ && !expired(now_ns)) return CommandFault::kOvertaken;
  term_ = command.term;
  last_stamp_ns_ = command.stamp_ns;
  motor_command_.state = command.rotor_state;
  for (std::size_t i = 0; i < count; ++i) motor_command_.throttle[i] = command.throttle[i];
  return CommandFault::kNone;
}

bool ActuatorWatchdog::expired(std::int64_t now_ns) const {
  return last_stamp_ns_ && *last_stamp_ns_ < now_ns - timeout_ns_;
}

ObeyedCommand ActuatorWatchdog::obeyed() const {
  return {true, last_stamp_ns_.has_value(), term_, last_stamp_ns_.value_or(0)};
}

const MotorCommand& ActuatorWatchdog::motor_command(std::int64_t now_ns) const {
  static constexpr MotorCommand kOff;
  return expired(now_ns) ? kOff : motor_command_;
}

}  // namespace swiftlet::plant
