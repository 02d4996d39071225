// A flight of models that are in no file.
#pragma once

#include <optional>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::ground {

// Those that are set take the place of the files that FlyOptions names.
struct FlightInputs {
  std::optional<plant::Vehicle> vehicle;
  std::optional<control::ControlSettings> control;
  std::optional<plant::SimulationSettings> simulation;
  std::optional<io::MissionFile> mission;

  bool any() const { return vehicle || control || simulation || mission; }
};

// As plan_flight() of launch_configuration.hpp. Only for launch mode kInProcess. Throws InputError also for a model
// that breaks a rule.
LaunchConfiguration plan_flight(const FlyOptions& options, const FlightInputs& given);

}  // namespace swiftlet::ground
