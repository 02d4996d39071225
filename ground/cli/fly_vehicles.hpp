// Flies planned vehicles at the same time, from one command.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "swiftlet/ground/fleet/fleet_monitor.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"

namespace swiftlet::ground {

// Starts the processes, or attaches to running ones, flies the i-th plan with the i-th vehicle, writes the records and
// prints the reports. options: of the command; the plans were made of them. monitor: of the vehicles in this order; keeps
// them apart in real time. Returns the program's exit code.
int fly_vehicles(const FlyOptions& options, const std::vector<std::string>& vehicles,
                 std::vector<LaunchConfiguration> planned, std::optional<FleetMonitor> monitor = {});

}  // namespace swiftlet::ground
