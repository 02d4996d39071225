#include "swiftlet/plant/simulation/links/command_path.hpp"

#include <cmath>

#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::plant {

namespace {

std::size_t delay_capacity(const FaultSchedule& faults, const SimulationSettings& settings) {
  const double longest_s =
      faults.longest_delay_s(FaultKind::kCommandsDelay) + settings.radio.delay_s + settings.radio.jitter_s;
  return longest_s > 0.0 ? static_cast<std::size_t>(longest_s * settings.imu.rate_hz) + 4 : 0;
}

}  // namespace

CommandPath::CommandPath(const SimulationSettings& settings, std::uint64_t seed)
    : faults_(settings.faults),
      radio_(settings.radio, seed, streams::kRadioCommands),
      direct_(!radio_.on() && !faults_.has(FaultKind::kCommandsStop) &&
              !faults_.has(FaultKind::kCommandsDelay)),
      delayed_(delay_capacity(faults_, settings)) {}

bool CommandPath::send_late(const VehicleCommand& command, std::int64_t now_ns) {
  const std::optional<std::int64_t> takes_ns = radio_.send(now_ns);
  if (!takes_ns || faults_.active(FaultKind::kCommandsStop, now_ns) != nullptr) return false;
  const Fault* delay = faults_.active(FaultKind::kCommandsDelay, now_ns);
  const std::int64_t late_ns = *takes_ns + (delay != nullptr ? math::nanoseconds(delay->delay_s) : 0);
  if (late_ns > 0) {
    delayed_.put(command, now_ns + late_ns);
    return false;
  }
  delayed_.clear();  // older commands are superseded
  return true;
}

}  // namespace swiftlet::plant
