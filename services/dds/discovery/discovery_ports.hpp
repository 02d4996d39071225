// The UDP ports for discovery between the processes of a host. The RTPS standard assigns them to a DDS
// domain: every second port from the first of this domain to the first of the next.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

namespace swiftlet::dds {

struct DiscoveryPorts {
  std::uint32_t first = 0;
  std::uint32_t count = 0;  // largest number of processes
  std::uint32_t gap = 0;

  std::uint32_t last() const { return first + (count - 1) * gap; }
  std::optional<std::uint32_t> index_of(std::uint32_t port) const;  // from 0; nullopt: none of them
};

// 120 ports; 63 in domain 232, whose ports end with those of UDP.
DiscoveryPorts discovery_ports(int domain);

// The error "DDS domain 5 is full ...": all ports are taken. The others would not discover one more process.
std::runtime_error domain_is_full(int domain);

// Why a UDP port cannot be opened, an errno; 0 if it can. address: an IPv4 address of this host; empty: all of them.
int error_of_binding(std::uint32_t port, const std::string& address);

// Returns the index of the first free port of the domain, from 0. address: as above. Throws domain_is_full().
std::uint32_t free_discovery_port(int domain, const std::string& address);

// Returns to how many of the domain's ports a process with port index `own` announces itself: to all ports
// below its own and some above. Of two processes, the one with the higher port thus always reaches the other,
// which then answers. In a domain of few processes each reaches all others, and few announcements go to
// unused ports.
std::uint32_t announced_ports(const DiscoveryPorts& ports, std::uint32_t own);

}  // namespace swiftlet::dds
