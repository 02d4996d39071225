// The options that the ways to fly a mission share.
#pragma once

#include "ground/flight_plan.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace swiftlet::ground {

// `options` must outlive the parsing.
// Mission, vehicle, control, simulation, seed, imu-rate.
void add_mission_options(CLI::App& app, FlyOptions& options);
// These, record and json.
void add_fly_options(CLI::App& app, FlyOptions& options);
// vary
CLI::Option* add_vary_option(CLI::App& app, FlyOptions& options);

}  // namespace swiftlet::ground
