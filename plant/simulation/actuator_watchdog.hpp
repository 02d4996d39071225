// Watchdog of the vehicle over the actuator commands that it receives. It rejects invalid commands and stops
// the rotors if no valid command arrives within the time-out.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/simulation/vehicle_state.hpp"

namespace swiftlet::plant {

enum class CommandFault : std::uint8_t {
  kNone,
  kRotorCount,  // rotor count differs from the vehicle's
  kRotorState,  // rotor state is neither off nor running
  kThrottle,    // throttle is not finite or outside 0 .. 1
  kStale,       // IMU stamp is older than the last command's, or older than the time-out
  kFuture,      // IMU stamp is later than the vehicle's clock
  kOvertaken,   // term is lower than that of the controller in command
};
const char* to_string(CommandFault fault);  // "throttle is not a number within 0 .. 1"

class ActuatorWatchdog {
 public:
  ActuatorWatchdog(int rotor_count, std::int64_t timeout_ns);

  // Processes a command that arrives at now_ns on the vehicle's clock. A command with a fault is ignored.
  // Commands with a term below that of the last accepted one are rejected until that one is older than the
  // time-out.
  CommandFault accept(const ActuatorCommand& command, std::int64_t now_ns);

  // Motor command at now_ns: the last accepted command, or off if its IMU sample is older than the time-out.
  const MotorCommand& motor_command(std::int64_t now_ns) const;

  // True if a command has been accepted and its IMU sample is older than the time-out.
  bool expired(std::int64_t now_ns) const;

  // The last accepted command, as the vehicle reports it to the controllers.
  ObeyedCommand obeyed() const;

 private:
  int rotor_count_;
  std::int64_t timeout_ns_;
  std::optional<std::int64_t> last_stamp_ns_;
  std::uint32_t term_ = 0;
  MotorCommand motor_command_;
};

}  // namespace swiftlet::plant
