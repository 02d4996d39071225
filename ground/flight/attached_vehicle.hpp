// The check before a flight with processes that run already, which others may command too.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// Throws std::runtime_error with a sentence if a vehicle is in flight. Likewise if no process of it is found
// within 5 s, or only a control service that cannot be heard. Returns if other processes are found: control may
// still be starting.
void require_on_ground(const comms::NodeSettings& network, const std::vector<std::string>& vehicles);

}  // namespace swiftlet::ground
