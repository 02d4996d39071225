// The network interfaces that a node uses.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/io/network/host_address.hpp"

namespace swiftlet::io {

constexpr const char* kLoopback = "127.0.0.1";

// An IPv4 address of an interface that is up and plugged in: Fast DDS ignores others.
struct Interface {
  std::string name;     // "eth0"
  std::string address;  // "192.168.1.4"
  bool is_loopback = false;
  bool has_multicast = false;
  int mtu_bytes = 0;  // 0: unknown
  Ipv4 ipv4 = 0;      // the address
};
std::vector<Interface> interfaces_up();

// Whether one of them has the address.
bool is_own_address(const std::string& ipv4);

// The interfaces with an IPv4 address that are up: "lo (127.0.0.1), eth0 (192.168.1.4)". Only the loopback
// interface if localhost_only.
std::string interfaces_text(bool localhost_only);

// Why this is no name or IPv4 address of an interface that is up: "is 'eth9', must be an interface that is up, by name
// or address: lo (127.0.0.1)"; empty if it is.
std::string fault_of_interface(const std::string& name_or_address);

// The addresses of these interfaces, given by name or address. Throws std::runtime_error if one is not up.
std::vector<std::string> addresses_of_interfaces(const std::vector<std::string>& names_or_addresses);

}  // namespace swiftlet::io
