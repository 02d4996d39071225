// Where a process looks for the others, for messages.
#pragma once

#include <string>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

// " on the loopback interface", " at the peers lab1, lab2", " by the discovery server lab1:11811", " on eth0"; empty
// if nothing limits the search.
std::string search_text(const NodeSettings& settings);

}  // namespace swiftlet::comms
