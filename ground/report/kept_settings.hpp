// The settings of a recorded flight, read back from beside it.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace swiftlet::ground {

// Key and value of every single setting of control.yaml, mission.yaml, simulation.yaml and vehicle.yaml, as far as the folder
// holds them: "control.position.x.omega_n",
// "2.0". Throws runtime::ConfigError for a file that is no YAML.
std::vector<std::pair<std::string, std::string>> kept_settings(const std::filesystem::path& folder);

}  // namespace swiftlet::ground
