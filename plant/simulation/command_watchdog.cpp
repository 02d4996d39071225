#include "swiftlet/plant/simulation/command_watchdog.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::plant {
namespace {

CommandFault finite_unless(bool faulty) { return faulty ? CommandFault::kNotFinite : CommandFault::kNone; }

bool is_thrust(double thrust_n) { return std::isfinite(thrust_n) && thrust_n >= 0.0; }

}  // namespace

const char* to_string(CommandFault fault) {
  switch (fault) {
    case CommandFault::kNone:
      return "no fault";
    case CommandFault::kLevel:
      return "the vehicle does not accept commands at this level";
    case CommandFault::kRotorCount:
      return "rotor count differs from the vehicle's";
    case CommandFault::kRotorState:
      return "rotor state is neither off nor running";
    case CommandFault::kThrottle:
      return "throttle is not a number within 0 .. 1";
    case CommandFault::kNotFinite:
      return "a setpoint is not a finite number, or its thrust is negative";
    case CommandFault::kStale:
      return "answers an outdated IMU sample";
    case CommandFault::kFuture:
      return "answers an IMU sample of the future";
    case CommandFault::kOvertaken:
      return "a controller with a higher term has taken over";
  }
  return "";
}

CommandWatchdog::CommandWatchdog(int rotor_count, std::int64_t timeout_ns, ControlLevels levels,
                                 std::int64_t hold_ns)
    : rotor_count_(rotor_count), timeout_ns_(timeout_ns), hold_ns_(hold_ns), levels_(levels) {}

CommandFault CommandWatchdog::check(const ActuatorCommand& command) const {
  if (command.rotor_count != rotor_count_) return CommandFault::kRotorCount;
  for (std::size_t i = 0; i < static_cast<std::size_t>(rotor_count_); ++i) {
    if (!(command.throttle[i] >= 0.0 && command.throttle[i] <= 1.0)) return CommandFault::kThrottle;
  }
  return CommandFault::kNone;
}

CommandFault CommandWatchdog::check(const RatesSetpoint& setpoint) {
  return finite_unless(!setpoint.body_rates_frd.allFinite() || !is_thrust(setpoint.thrust_n));
}

CommandFault CommandWatchdog::check(const AttitudeSetpoint& setpoint) {
  return finite_unless(!setpoint.q_ned_from_frd.coeffs().allFinite() ||
                       !setpoint.body_rates_frd.allFinite() || !is_thrust(setpoint.thrust_n));
}

CommandFault CommandWatchdog::check(const TrajectorySetpoint& setpoint) {
  return finite_unless(!setpoint.position_ned.allFinite() || !setpoint.velocity_ned.allFinite() ||
                       !setpoint.acceleration_ned.allFinite() || !std::isfinite(setpoint.yaw_rad) ||
                       !std::isfinite(setpoint.yaw_rate));
}

CommandFault CommandWatchdog::accept(const VehicleCommand& command, std::int64_t now_ns) {
  const CommandHeader& header = header_of(command);
  if (header.rotor_state != RotorState::kOff && header.rotor_state != RotorState::kRunning) {
    return CommandFault::kRotorState;
  }
  const bool turns_off =
      header.rotor_state == RotorState::kOff && level_of(command) == ControlLevel::kActuators;
  if (!levels_.has(level_of(command)) && !turns_off) return CommandFault::kLevel;
  const auto* const actuators = std::get_if<ActuatorCommand>(&command);
  const CommandFault content = actuators != nullptr
                                   ? check(*actuators)
                                   : std::visit([&](const auto& one) { return check(one); }, command);
  if (content != CommandFault::kNone) return content;
  if (header.stamp_ns > now_ns) return CommandFault::kFuture;
  if (last_stamp_ns_ && header.stamp_ns < *last_stamp_ns_) return CommandFault::kStale;
  if (header.stamp_ns < now_ns - timeout_ns_) return CommandFault::kStale;
  if (header.term < header_of(command_).term && !expired(now_ns)) return CommandFault::kOvertaken;
  last_stamp_ns_ = header.stamp_ns;
  idle_.state = header.rotor_state;
  motor_command_ = idle_;
  if (actuators != nullptr) {
    command_ = *actuators;
    std::copy_n(actuators->throttle.begin(), rotor_count_, motor_command_.throttle.begin());
  } else {
    command_ = command;
  }
  return CommandFault::kNone;
}

const MotorCommand& CommandWatchdog::motor_command(std::int64_t now_ns) const {
  static constexpr MotorCommand kOff;
  if (expired(now_ns)) return kOff;
  return outdated(now_ns) ? idle_ : motor_command_;
}

ObeyedCommand CommandWatchdog::obeyed() const {
  return {true, last_stamp_ns_.has_value(), header_of(command_).term, last_stamp_ns_.value_or(0)};
}

}  // namespace swiftlet::plant
