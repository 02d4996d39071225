// What a process says of the network: where it looks for the others, who reaches it, and who joins and leaves.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::dds {

// " on the loopback interface" with what opens the network, " at the peers lab1, lab2", " by the discovery server
// lab1:11811", " on eth0"; empty if nothing limits the search.
std::string search_text(const NodeSettings& settings);

// What to do if nothing is found, "check that ..." or "datagrams from 10.0.0.2 are refused, ...". refused_keys: those of the participant.
std::string search_advice(const NodeSettings& settings, const std::vector<std::string>& refused_keys);

// One line of a service that says that only this host reaches it, or that anybody does; none if its options say it.
void log_reach(const NodeSettings& settings);

// Logs discovered and lost peers of the node, whose on_peer() callback it sets.
void log_peers(Node& node);

}  // namespace swiftlet::dds
