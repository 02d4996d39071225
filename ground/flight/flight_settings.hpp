// The settings that a recorded flight was flown with, kept beside it.
#pragma once

#include "swiftlet/ground/flight/launch_configuration.hpp"

namespace swiftlet::ground {

// Copies mission.yaml into the record's folder, and control.yaml, vehicle.yaml and simulation.yaml too,
// unless the flight is one over processes that run already: those know their own. Throws std::runtime_error
// if it cannot.
void keep_settings(const LaunchConfiguration& plan);

}  // namespace swiftlet::ground
