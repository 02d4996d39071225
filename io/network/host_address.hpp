// Addresses of other hosts, as the user writes them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace swiftlet::io {

using Ipv4 = std::uint32_t;  // 127.0.0.1 is 0x7f000001
constexpr bool is_loopback(Ipv4 address) { return address >> 24U == 127; }
std::string to_string(Ipv4 address);

// "HOST" or "HOST:PORT"; HOST is a name or an IPv4 address.
struct HostAddress {
  std::string host;
  std::uint16_t port = 0;  // 0: not given
};

// Why the text is not such an address: "is 'a:b', must be HOST or HOST:PORT with a port from 1 to 65535"; empty if
// it is.
std::string fault_of_host_address(const std::string& text);
// Requires that fault_of_host_address() is empty.
HostAddress parse_host_address(const std::string& text);

// The IPv4 addresses of a host, from /etc/hosts or DNS. Throws std::runtime_error, "host 'lab2' is unknown: Name or
// service not known".
std::vector<std::string> ipv4_addresses_of(const std::string& host);

// Discovery servers of DDS, in the syntax of ROS_DISCOVERY_SERVER: "lab1:11811;lab2:11811". The place in the list is the number of
// the server, from 0; a number without a server is left empty.
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

}  // namespace swiftlet::io
