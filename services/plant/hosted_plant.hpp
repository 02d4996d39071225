// A simulated vehicle of swiftlet-plant, which serves one or several.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/plant/autopilot_loop.hpp"
#include "swiftlet/services/plant/autopilot_settings.hpp"
#include "swiftlet/services/plant/lockstep_loop.hpp"
#include "swiftlet/services/plant/plant_reporter.hpp"
#include "swiftlet/services/plant/realtime_loop.hpp"
#include "swiftlet/services/plant/simulated_vehicle.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/services/runtime/hosting.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::services {

struct PlantSettings {
  plant::Vehicle vehicle;
  plant::SimulationSettings simulation;
  runtime::Clock clock = runtime::Clock::kRealtime;
  double speed = 0.0;  // 0: real time, or in lockstep no limit
  LockstepSettings lockstep;
  runtime::RealtimeSettings realtime;
  std::uint64_t seed = 1;
  plant::VehicleState initial;
  std::optional<AutopilotSettings> autopilot;  // flies the vehicle in place of the control service
};

class HostedPlant final : public runtime::HostedVehicle {
 public:
  // loop: steps the vehicle in real time. Throws as Node, LockstepLoop and AutopilotLoop do.
  HostedPlant(const dds::Participant& participant, const std::string& name, const PlantSettings& settings,
              RealtimeLoop& loop);
  ~HostedPlant() override;

  void run(const std::atomic<bool>& stop) override;
  void attend() override;
  void log_end() override { PlantReporter::log_end(last_); }

 private:
  dds::Node node_;
  std::optional<PlantReporter> reporter_;  // none with truth_only
  SimulatedVehicle simulated_;
  PlantReport last_;
  RealtimeLoop& realtime_loop_;
  std::optional<RealtimeVehicle> realtime_;  // last: their subscriptions use all members above
  std::optional<LockstepLoop> lockstep_loop_;
  std::optional<AutopilotLoop> autopilot_loop_;
};

}  // namespace swiftlet::services
