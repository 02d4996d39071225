#include "swiftlet/services/plant/hosted_plant.hpp"

#include "swiftlet/services/dds/discovery/peer_log.hpp"

namespace swiftlet::services {

HostedPlant::HostedPlant(const comms::Participant& participant, const std::string& name,
                         const PlantSettings& settings)
    : HostedVehicle(name),
      node_(participant, name, [this](const std::string& fault) { fail(fault); }),
      reporter_(node_, settings.vehicle, settings.simulation),
      simulated_(settings.vehicle, settings.simulation, settings.seed, settings.initial, node_) {
  comms::log_peers(node_);
  if (settings.clock == runtime::Clock::kRealtime) {
    const double speed = settings.speed > 0.0 ? settings.speed : 1.0;
    realtime_loop_.emplace(simulated_, settings.simulation, speed, settings.phase, node_, settings.realtime);
  } else {
    LockstepSettings lockstep = settings.lockstep;
    lockstep.speed = settings.speed;
    lockstep_loop_.emplace(simulated_, settings.simulation, settings.seed, lockstep,
                           settings.vehicle.rotor_count(), node_);
  }
}

void HostedPlant::run(const std::atomic<bool>& stop) {
  if (realtime_loop_) realtime_loop_->run(stop);
  if (lockstep_loop_) lockstep_loop_->run(stop);
}

void HostedPlant::attend() {
  simulated_.reports().take(last_);
  reporter_.publish_due(last_);
}

}  // namespace swiftlet::services
