// The UDP ports at which the processes of a host hear of each other: those that the RTPS standard gives to a
// DDS domain, every second one between the first of this domain and the first of the next.
#pragma once

#include <cstdint>

namespace swiftlet::comms {

struct DiscoveryPorts {
  std::uint32_t first = 0;
  std::uint32_t count = 0;  // of processes that find each other
  std::uint32_t gap = 0;

  std::uint32_t last() const { return first + (count - 1) * gap; }
};

// 120 ports; 63 in domain 232, whose ports end with those of UDP.
DiscoveryPorts discovery_ports(int domain);

// Throws std::runtime_error with a sentence if all of the domain's ports are taken: a process more would be
// found by none of the others.
void demand_discovery_port(int domain, bool localhost_only);

}  // namespace swiftlet::comms
