// Copies the settings of a flight into its record.
#pragma once

#include "swiftlet/ground/flight/launch_configuration.hpp"

namespace swiftlet::ground {

// Copies the mission file into the record's folder, control.yaml and vehicle.yaml, and simulation.yaml unless the flight is attached
// to running processes. Throws std::runtime_error if a file cannot be copied.
void keep_settings(const LaunchConfiguration& plan);

}  // namespace swiftlet::ground
