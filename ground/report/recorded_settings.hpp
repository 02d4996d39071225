// The settings in a flight record.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace swiftlet::ground {

// Returns key and value, such as "control.position.x.omega_n" and "2.0", of every setting in control.yaml,
// mission.yaml, simulation.yaml and vehicle.yaml. Skips a file that does not exist. Throws
// runtime::ConfigError for a file that is not YAML.
std::vector<std::pair<std::string, std::string>> recorded_settings(const std::filesystem::path& folder);

// The same, of the texts of such files by their names. source: of the texts, for errors
std::vector<std::pair<std::string, std::string>> recorded_settings(
    const std::string& source, const std::map<std::string, std::string>& texts);

}  // namespace swiftlet::ground
