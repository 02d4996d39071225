// The vehicle's own guard over the commands that reach it: refuses broken ones, and stops the rotors when
// good ones cease.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/simulation/vehicle_state.hpp"

namespace swiftlet::plant {

enum class CommandFault : std::uint8_t {
  kNone,
  kRotorCount,  // not the vehicle's
  kRotorState,  // neither off nor running
  kThrottle,    // not finite, or outside 0 .. 1
  kStale,       // answers an older sample than the last command did, or one beyond the time-out
  kFuture,      // answers a sample that has not been taken
  kOvertaken,   // of a controller from which another has taken over
};
const char* to_string(CommandFault fault);  // "throttle is not a number within 0 .. 1"

class ActuatorWatchdog {
 public:
  ActuatorWatchdog(int rotor_count, std::int64_t timeout_ns);

  // A command that arrives at now_ns, the vehicle's clock. One with a fault counts as no command. A term
  // rules out lower ones until its commands are older than the time-out.
  CommandFault accept(const ActuatorCommand& command, std::int64_t now_ns);

  // What the rotors are to do at now_ns: the last command, or off if it answers a sample older than the
  // time-out.
  const MotorCommand& drive(std::int64_t now_ns) const;

  // A command has been accepted, and it is older than the time-out.
  bool expired(std::int64_t now_ns) const;

  // For the controllers to know.
  ObeyedCommand obeyed() const;

 private:
  int rotor_count_;
  std::int64_t timeout_ns_;
  std::optional<std::int64_t> last_stamp_ns_;
  std::uint32_t term_ = 0;
  MotorCommand drive_;
};

}  // namespace swiftlet::plant
