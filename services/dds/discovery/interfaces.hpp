// The network interfaces that a node uses.
#pragma once

#include <string>

namespace swiftlet::comms {

// The interfaces with an IPv4 address that are up: "lo (127.0.0.1), eth0 (192.168.1.4)". Only the loopback
// interface if localhost_only.
std::string interfaces_text(bool localhost_only);

}  // namespace swiftlet::comms
