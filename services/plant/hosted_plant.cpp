#include "swiftlet/services/plant/hosted_plant.hpp"

#include "swiftlet/plant/simulation/no_effect.hpp"
#include "swiftlet/services/dds/reach.hpp"
#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::services {
namespace {

AutopilotLoopSettings autopilot_loop_settings(const PlantSettings& settings) {
  AutopilotLoopSettings loop;
  loop.autopilot = *settings.autopilot;
  loop.clock = settings.clock;
  loop.speed = settings.speed > 0.0 ? settings.speed : 1.0;
  loop.limited_in_lockstep = settings.speed > 0.0;
  loop.trace = settings.lockstep.trace;
  loop.realtime = settings.realtime;
  return loop;
}

}  // namespace

HostedPlant::HostedPlant(const dds::Participant& participant, const std::string& name,
                         const PlantSettings& settings, RealtimeLoop& loop)
    : HostedVehicle(name),
      node_(participant, name, [this](const std::string& fault) { fail(fault); }),
      simulated_(settings.vehicle, settings.simulation, settings.seed, settings.initial, node_,
                 settings.autopilot && settings.autopilot->truth_only),
      realtime_loop_(loop) {
  dds::log_peers(node_);
  for (const std::string& warning : plant::settings_without_effect(settings.simulation, settings.vehicle))
    runtime::log_warning("{}", warning);
  if (!settings.autopilot || !settings.autopilot->truth_only)
    reporter_.emplace(node_, settings.vehicle, settings.simulation,
                      settings.autopilot ? settings.autopilot->description() : "");
  if (settings.autopilot) {
    autopilot_loop_.emplace(simulated_, settings.vehicle, settings.simulation, settings.seed,
                            autopilot_loop_settings(settings), node_);
  } else if (settings.clock == runtime::Clock::kRealtime) {
    const double speed = settings.speed > 0.0 ? settings.speed : 1.0;
    realtime_.emplace(simulated_, settings.simulation, speed, node_, settings.realtime);
  } else {
    LockstepSettings lockstep = settings.lockstep;
    lockstep.speed = settings.speed;
    lockstep_loop_.emplace(simulated_, settings.simulation, settings.seed, lockstep,
                           settings.vehicle.rotor_count(), node_);
  }
}

HostedPlant::~HostedPlant() {
  if (realtime_) realtime_loop_.remove(*realtime_);
}

void HostedPlant::run(const std::atomic<bool>& stop) {
  if (realtime_) realtime_loop_.add(*realtime_, [this](const std::string& fault) { fail(fault); });
  if (lockstep_loop_) lockstep_loop_->run(stop);
  if (autopilot_loop_) autopilot_loop_->run(stop);
}

void HostedPlant::attend() {
  simulated_.reports().take(last_);
  if (reporter_) reporter_->publish_due(last_);
}

}  // namespace swiftlet::services
