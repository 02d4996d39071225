// The QoS of a participant: discovery, transport and name.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/rtps/datagram_guard.hpp"

namespace swiftlet::dds {

constexpr const char* kAnyAddress = "0.0.0.0";

fastrtps::Locator_t udp_locator(const std::string& ipv4, std::uint32_t port);

// announced_ports: number of ports to which it announces itself without multicast (discovery_ports.hpp).
// guard: checks the datagrams that it receives. Throws std::runtime_error for an unknown host or interface, and
// io::ConfigError for an invalid profile, malformed servers and peers.
eprosima::fastdds::dds::DomainParticipantQos participant_qos(
    const NodeSettings& settings, std::uint32_t announced_ports,
    const std::shared_ptr<rtps::DatagramGuard>& guard);

}  // namespace swiftlet::dds
