// The options that the ways to fly a mission share.
#pragma once

#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::ground {

// `options` must outlive the parsing.
// Mission, vehicle, control, simulation, seed, imu-rate.
void add_mission_options(runtime::CommandLine app, FlyOptions& options);
// These, record and json.
void add_fly_options(runtime::CommandLine app, FlyOptions& options);
// vary
runtime::Option add_vary_option(runtime::CommandLine app, FlyOptions& options);

}  // namespace swiftlet::ground
