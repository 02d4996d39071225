// Flies planned vehicles at the same time, from one command.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "swiftlet/ground/fleet/fleet_watch.hpp"
#include "swiftlet/ground/flight/attached_vehicle.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"

namespace swiftlet::ground {

// Begins to watch a flight of several vehicles, in the order of the command; what it returns ends the watch when it is destroyed.
// gives_up: true from when the flight is abandoned, and all are landed. Called from several threads.
using StartWatch = std::function<std::shared_ptr<void>(std::vector<WatchedVehicle> vehicles,
                                                       std::function<bool()> gives_up)>;

// The vehicles that run already, with --attach; empty without. Throws as require_on_ground() does.
std::vector<StandingVehicle> running_vehicles(const FlyOptions& options,
                                              const std::vector<std::string>& vehicles);

// Starts the processes, or attaches to running ones, flies the i-th plan with the i-th vehicle, writes the records and
// prints the reports. options: of the command; the plans were made of them. running: of
// running_vehicles(). start_watch: keeps several vehicles apart. Returns
// the program's exit code.
int fly_vehicles(const FlyOptions& options, const std::vector<std::string>& vehicles,
                 std::vector<LaunchConfiguration> planned, const std::vector<StandingVehicle>& running,
                 const StartWatch& start_watch = {});

}  // namespace swiftlet::ground
