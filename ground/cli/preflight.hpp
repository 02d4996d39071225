// The part of `swiftlet check vehicle` that needs no motion, before a vehicle of others is armed.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// Takes about a second for each vehicle, up to three times that if something fails. Prints the table of a vehicle that
// fails to standard error, and throws std::runtime_error. A simulated vehicle in lockstep is not checked.
void require_sound_vehicles(const dds::NodeSettings& network, const std::vector<std::string>& vehicles);

}  // namespace swiftlet::ground
