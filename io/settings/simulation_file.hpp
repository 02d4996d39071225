// The simulation file: YAML with the values of plant/simulation/settings.hpp. Key names end with the unit.
// All keys are required except `faults`, the list of faults to inject. config/simulation/default.yaml shows
// the required keys, faults_example.yaml the faults.
#pragma once

#include <string>
#include <string_view>

#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::io {

// Returns settings that pass plant::validate(). Throws ConfigError otherwise. file_name appears in messages
// only.
plant::SimulationSettings parse_simulation_settings(std::string_view text, const std::string& file_name);
plant::SimulationSettings load_simulation_settings(const std::string& path);

}  // namespace swiftlet::io
