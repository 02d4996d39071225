// The options that the commands which fly a mission have in common.
#pragma once

#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::ground {

// In all functions `options` must outlive the parsing.

// Adds mission, --vehicle, --control, --simulation, --seed and --imu-rate.
void add_mission_options(runtime::CommandLine app, FlyOptions& options);
// Adds the options of add_mission_options(), --record, --replace, --sensors and --json.
void add_fly_options(runtime::CommandLine app, FlyOptions& options);
// Adds --dispersion.
runtime::Option add_dispersion_option(runtime::CommandLine app, FlyOptions& options);

}  // namespace swiftlet::ground
