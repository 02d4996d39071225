#include "swiftlet/services/dds/discovery/discovery_ports.hpp"

#include <algorithm>
#include <cerrno>
#include <limits>
#include <string>
#include <sys/socket.h>

#include "swiftlet/io/descriptor.hpp"
#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::dds {
namespace {

// Enough for a fleet of four vehicles, in which each process announces itself to all others.
constexpr std::uint32_t kPortsAbove = 16;

}  // namespace

std::optional<std::uint32_t> DiscoveryPorts::index_of(std::uint32_t port) const {
  if (port < first || port > last() || (port - first) % gap != 0) return std::nullopt;
  return (port - first) / gap;
}

DiscoveryPorts discovery_ports(int domain) {
  const fastrtps::PortParameters parameters;
  DiscoveryPorts ports;
  ports.first = parameters.getUnicastPort(static_cast<std::uint32_t>(domain), 0);
  ports.gap = parameters.participantIDGain;
  // The data port of a process follows its discovery port.
  const std::uint32_t data_offset = parameters.offsetd3 - parameters.offsetd1;
  const std::uint32_t end =
      std::min<std::uint32_t>(ports.first - parameters.offsetd1 + parameters.domainIDGain,
                              std::numeric_limits<std::uint16_t>::max() + 1U);
  ports.count = (end - data_offset - ports.first + ports.gap - 1) / ports.gap;
  return ports;
}

std::runtime_error domain_is_full(int domain) {
  const DiscoveryPorts ports = discovery_ports(domain);
  return std::runtime_error("DDS domain " + std::to_string(domain) + " is full: all of its " +
                            std::to_string(ports.count) + " ports for discovery on this host, UDP " +
                            std::to_string(ports.first) + " to " + std::to_string(ports.last()) +
                            ", are taken; choose another with --domain");
}

int error_of_binding(std::uint32_t port, const std::string& own_address) {
  const io::Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!socket.is_open()) return 0;  // unknown; Fast DDS will report the error
  const sockaddr_in address = io::socket_address(own_address, static_cast<int>(port));
  const bool bound = ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  return bound ? 0 : errno;
}

std::uint32_t free_discovery_port(int domain, const std::string& address) {
  const DiscoveryPorts ports = discovery_ports(domain);
  for (std::uint32_t i = 0; i < ports.count; ++i) {
    if (error_of_binding(ports.first + i * ports.gap, address) == 0) return i;
  }
  throw domain_is_full(domain);
}

std::uint32_t announced_ports(const DiscoveryPorts& ports, std::uint32_t own) {
  return std::min(own + 1 + kPortsAbove, ports.count);
}

}  // namespace swiftlet::dds
