// `swiftlet gains --level`: the loops of a vehicle that closes its inner loops itself.
#pragma once

#include <array>
#include <string>

#include "swiftlet/control/design/level_loops.hpp"
#include "swiftlet/control/design/margins.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {

// The loops of the simulated firmware, plant/simulation/firmware/gains.hpp: those that a manufacturer would choose for
// this vehicle.
control::VehicleLoops vehicle_loops(const plant::Vehicle& vehicle);

struct LevelGains {
  std::string vehicle, control;  // names
  plant::ControlLevel level = plant::ControlLevel::kRates;
  double delay_s = 0.0;  // from a sample to the vehicle that obeys the command
  double rotor_lag_s = 0.0;
  control::VehicleLoops loops_of_vehicle;
  control::ControlGains gains;
  std::array<control::LoopMargins, 6> margins;  // in the order of control::kFlownLoopNames
  std::array<double, 6> tolerated_delay_s{};    // infinite if no delay up to 0.5 s makes the loop unstable
};

// level: not actuators. Throws as control::design().
LevelGains level_gains(const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                       plant::ControlLevel level, double delay_s);

// As JSON, indented by two spaces, without a newline at the end: the fields of LevelGains, `closed_by` of each loop
// "control" or "vehicle"; infinite margins are null.
std::string level_gains_json(const LevelGains& gains);
// As a table for a terminal, with a newline at the end.
std::string level_gains_table(const LevelGains& gains);

}  // namespace swiftlet::ground
