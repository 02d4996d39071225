// Link of the commands from the controller to the vehicle: the radio, if there is one, and the injected faults (loss,
// delay).
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/plant/model/vehicle_command.hpp"
#include "swiftlet/plant/simulation/links/delay_line.hpp"
#include "swiftlet/plant/simulation/links/faults.hpp"
#include "swiftlet/plant/simulation/links/radio.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

class CommandPath {
 public:
  CommandPath(const SimulationSettings& settings, std::uint64_t seed);

  // Sends a command at now_ns. Returns true if it arrives immediately.
  bool send(const VehicleCommand& command, std::int64_t now_ns) {
    return direct_ || send_late(command, now_ns);
  }

  // The newest delayed command that has arrived by now_ns, if any.
  std::optional<VehicleCommand> arrived(std::int64_t now_ns) {
    if (delayed_.empty()) return std::nullopt;
    return delayed_.take(now_ns);
  }

 private:
  bool send_late(const VehicleCommand& command, std::int64_t now_ns);

  FaultSchedule faults_;
  RadioLink radio_;
  bool direct_;
  DelayLine<VehicleCommand> delayed_;
};

}  // namespace swiftlet::plant
