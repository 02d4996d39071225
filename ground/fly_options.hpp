// The options that every way to fly a mission shares.
#pragma once

#include "ground/flight_plan.hpp"

namespace CLI {
class App;
}

namespace swiftlet::ground {

// Mission, vehicle, control, simulation, record, seed, imu-rate, json. `options` must outlive the parsing.
void add_fly_options(CLI::App& app, FlyOptions& options);

}  // namespace swiftlet::ground
