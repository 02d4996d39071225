// Addresses of other hosts, as the user writes them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace swiftlet::comms {

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

}  // namespace swiftlet::comms
