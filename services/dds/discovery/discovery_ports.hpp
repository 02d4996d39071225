// The UDP ports at which the processes of a host hear of each other: those that the RTPS standard gives to a
// DDS domain, every second one between the first of this domain and the first of the next.
#pragma once

#include <cstdint>
#include <set>
#include <stdexcept>

namespace swiftlet::comms {

struct DiscoveryPorts {
  std::uint32_t first = 0;
  std::uint32_t count = 0;  // of processes that find each other
  std::uint32_t gap = 0;

  std::uint32_t last() const { return first + (count - 1) * gap; }
};

// 120 ports; 63 in domain 232, whose ports end with those of UDP.
DiscoveryPorts discovery_ports(int domain);

// "DDS domain 5 is full": all ports are taken, a process more would be found by none of the others.
std::runtime_error domain_is_full(int domain);

// The first of the domain's ports that is free now, counted from 0. Throws domain_is_full().
std::uint32_t free_discovery_port(int domain, bool localhost_only);

// Those of them that a socket of this process has.
std::set<std::uint32_t> own_discovery_ports(int domain);

// To how many of the domain's ports a process announces itself that has the port of this number: to those
// below its own and some above. So of two processes, the one above always calls the one below, which then
// answers; in a domain of few processes each calls all others, and few ports that nobody has.
std::uint32_t announced_ports(const DiscoveryPorts& ports, std::uint32_t own);

}  // namespace swiftlet::comms
