// The simulation file: YAML with the keys of plant/simulation/settings.hpp, their units in their names.
// config/simulation/default.yaml shows all of them but `faults`, the list of faults to inject, which may be
// left out; faults_example.yaml shows those.
#pragma once

#include <string>
#include <string_view>

#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::runtime {

// Settings that plant::validate() finds no fault with. Throws ConfigError for anything else. All other keys
// must be given. file_name is for the messages only.
plant::SimulationSettings parse_simulation_settings(std::string_view text, const std::string& file_name);
plant::SimulationSettings load_simulation_settings(const std::string& path);

}  // namespace swiftlet::runtime
