#include "swiftlet/plant/simulation/links/command_path.hpp"

#include <cmath>

namespace swiftlet::plant {

namespace {

std::size_t delay_capacity(const FaultSchedule& faults, const ImuSettings& imu) {
  const double longest_s = faults.longest_delay_s(FaultKind::kCommandsDelay);
  return longest_s > 0.0 ? static_cast<std::size_t>(longest_s * imu.rate_hz) + 2 : 0;
}

}  // namespace

CommandPath::CommandPath(const SimulationSettings& settings)
    : faults_(settings.faults),
      faultless_(!faults_.has(FaultKind::kCommandsStop) && !faults_.has(FaultKind::kCommandsDelay)),
      delayed_(delay_capacity(faults_, settings.imu)) {}

bool CommandPath::send_with_faults(const VehicleCommand& command, std::int64_t now_ns) {
  if (faults_.active(FaultKind::kCommandsStop, now_ns) != nullptr) return false;
  if (const Fault* delay = faults_.active(FaultKind::kCommandsDelay, now_ns)) {
    delayed_.put(command, now_ns + std::llround(delay->delay_s * 1.0e9));
    return false;
  }
  delayed_.clear();  // older commands are superseded
  return true;
}

}  // namespace swiftlet::plant
