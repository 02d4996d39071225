// Watchdog of the vehicle over the commands that it receives. It rejects invalid commands. It has two stages, as that of
// the Crazyflie firmware: an outdated command is no longer obeyed, and after the time-out the rotors stop. Both count
// from the stamp of the IMU sample that the command answers, so that a stream of old commands is none. Commands of all
// levels have one term and one time-out.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle_command.hpp"
#include "swiftlet/plant/simulation/vehicle_state.hpp"

namespace swiftlet::plant {

enum class CommandFault : std::uint8_t {
  kNone,
  kLevel,       // the vehicle does not accept this level
  kRotorCount,  // rotor count differs from the vehicle's
  kRotorState,  // rotor state is neither off nor running
  kThrottle,    // throttle is not finite or outside 0 .. 1
  kNotFinite,   // a setpoint is not finite, or its thrust is negative
  kStale,       // IMU stamp is older than the last command's, or older than the time-out
  kFuture,      // IMU stamp is later than the vehicle's clock
  kOvertaken,   // term is lower than that of the controller in command
};
const char* to_string(CommandFault fault);  // "throttle is not a number within 0 .. 1"

constexpr std::int64_t kCommandHoldNs = 200'000'000;

class CommandWatchdog {
 public:
  // levels: those that the vehicle accepts. hold_ns: for which a command is obeyed; a longer one than the time-out has
  // no effect.
  CommandWatchdog(int rotor_count, std::int64_t timeout_ns, ControlLevels levels = ControlLevel::kActuators,
                  std::int64_t hold_ns = kCommandHoldNs);

  // Processes a command that arrives at now_ns on the vehicle's clock. A command with a fault is ignored.
  // Commands with a term below that of the last accepted one are rejected until that one is older than the
  // time-out. "Rotors off" at level actuators is accepted by every vehicle: a controller sends it before it knows the
  // levels.
  CommandFault accept(const VehicleCommand& command, std::int64_t now_ns);

  // The last accepted command; before the first one, rotors off.
  const VehicleCommand& command() const { return command_; }
  // Motor command at now_ns: off if the IMU sample of the last accepted command is older than the time-out. The throttles
  // are 0 if it is outdated, and at other levels than actuators: the vehicle's own loops give them.
  const MotorCommand& motor_command(std::int64_t now_ns) const;

  // True if a command has been accepted and its IMU sample is older than the time for which it holds.
  bool outdated(std::int64_t now_ns) const { return older_than(hold_ns_, now_ns); }
  // The same for the time-out.
  bool expired(std::int64_t now_ns) const { return older_than(timeout_ns_, now_ns); }

  // The last accepted command, as the vehicle reports it to the controllers.
  ObeyedCommand obeyed() const;

 private:
  CommandFault check(const ActuatorCommand& command) const;
  static CommandFault check(const RatesSetpoint& setpoint);
  static CommandFault check(const AttitudeSetpoint& setpoint);
  static CommandFault check(const TrajectorySetpoint& setpoint);
  bool older_than(std::int64_t age_ns, std::int64_t now_ns) const {
    return last_stamp_ns_ && *last_stamp_ns_ < now_ns - age_ns;
  }

  int rotor_count_;
  std::int64_t timeout_ns_;
  std::int64_t hold_ns_;
  ControlLevels levels_;
  std::optional<std::int64_t> last_stamp_ns_;
  VehicleCommand command_;
  MotorCommand motor_command_;
  MotorCommand idle_;  // as motor_command_, without throttles
};

}  // namespace swiftlet::plant
