// Where a process looks for the others, and who reaches it, for messages.
#pragma once

#include <string>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

// " on the loopback interface" with what opens the network, " at the peers lab1, lab2", " by the discovery server
// lab1:11811", " on eth0"; empty if nothing limits the search.
std::string search_text(const NodeSettings& settings);

// One line of a service that says that only this host reaches it, or that anybody does; none if its options say it.
void log_reach(const NodeSettings& settings);

}  // namespace swiftlet::comms
