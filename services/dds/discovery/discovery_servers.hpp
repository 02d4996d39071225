// Addresses of discovery servers, in the syntax of ROS_DISCOVERY_SERVER: "lab1:11811;lab2:11811". The place in the list
// is the number of the server, from 0; a number without a server is left empty.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/services/dds/discovery/host_address.hpp"

namespace swiftlet::comms {

constexpr int kDiscoveryServerPort = 11811;  // without a port, as in ROS 2
constexpr int kMaxDiscoveryServers = 256;

struct DiscoveryServerAddress {
  int number = 0;
  HostAddress address;  // with a port
};

// Why the text is not such a list; empty if it is.
std::string fault_of_discovery_servers(const std::string& list);
// Requires that fault_of_discovery_servers() is empty.
std::vector<DiscoveryServerAddress> parse_discovery_servers(const std::string& list);

}  // namespace swiftlet::comms
