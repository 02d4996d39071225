#include "swiftlet/services/control/hosted_control.hpp"

#include <stdexcept>

#include "swiftlet/services/dds/reach.hpp"
#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::services {

HostedControl::HostedControl(const dds::Participant& participant, const std::string& name,
                             const ControllerSettings& settings)
    : HostedVehicle(name),
      node_(participant, name, [this](const std::string& fault) { fail(fault); }),
      files_(settings.files),
      service_(settings.vehicle, settings.control, settings.failover_priority, node_, settings.realtime,
               settings.clock, settings.fixed, settings.level) {
  dds::log_peers(node_);
}

// A standby has no last sample: late joiners hear of the files of the active controller only.
void HostedControl::tell_files() {
  if (service_.active() == has_told_files_) return;
  has_told_files_ = service_.active();
  files_out_ = has_told_files_ ? node_.publish(messages::topics::kFlownFiles)
                               : dds::Publisher<messages::msg::FlownFiles>();
  if (has_told_files_) files_out_.publish(files_);
}

void HostedControl::attend() {
  tell_files();
  if (service_.has_rival())
    throw std::runtime_error("lockstep: another controller commands this vehicle; only one is allowed");
}

void HostedControl::log_end() {
  const Snapshot& last = service_.last();
  runtime::log_info(
      "ended in mode {}: {} steps at {:.1f} Hz since the rotors were last started, {} late, longest {:.0f} "
      "us",
      control::to_string(last.status.mode), last.timing.cycles, last.timing.rate_hz,
      last.timing.deadline_misses, static_cast<double>(last.timing.longest_ns) * 1e-3);
}

}  // namespace swiftlet::services
