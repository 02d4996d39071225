// The settings that a recorded flight was flown with, kept beside it.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/ground/flight_plan.hpp"

namespace swiftlet::ground {

// Copies mission.yaml into the record's folder, and control.yaml, vehicle.yaml and simulation.yaml too,
// unless the flight is one over processes that run already: those know their own. Throws std::runtime_error
// if it cannot.
void keep_settings(const FlightPlan& plan);

// Key and value of every single setting of those files that the folder holds: "control.position.x.omega_n",
// "2.0". Throws runtime::ConfigError for a file that is no YAML.
std::vector<std::pair<std::string, std::string>> kept_settings(const std::filesystem::path& folder);

}  // namespace swiftlet::ground
