// Settings and faults of a simulation that cannot have had an effect on a flight.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

// A sentence for each, with keys as in the simulation file: wind without drag, a fault of what this vehicle does not have, and
// one after simulated_s, at which the flight has ended.
std::vector<std::string> settings_without_effect(
    const SimulationSettings& settings, const Vehicle& vehicle,
    double simulated_s = std::numeric_limits<double>::infinity());

}  // namespace swiftlet::plant
