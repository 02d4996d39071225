// The QoS by which a participant finds other hosts: peers, discovery
// servers and interfaces.
#pragma once

#include <cstdint>
#include <string>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

constexpr const char* kAnyAddress = "0.0.0.0";

rtps::Locator_t udp_locator(const std::string& ipv4, std::uint32_t port);

// A locator with this port for each address at which the node is to be found: those of its interfaces, by default of all that
// are up but the loopback interface, which it has if there is no other. Of this moment: Fast DDS 3 remembers those of the
// first participant of the process.
rtps::LocatorList_t own_locators(const NodeSettings& settings, std::uint32_t port);

// Sets the interfaces of the transport, and with peers the addresses of discovery. announced_ports: as for
// participant_qos(). Throws std::runtime_error for an unknown host or interface, and
// ConfigError for malformed servers and peers.
void set_network(const NodeSettings& settings, std::uint32_t announced_ports,
                 eprosima::fastdds::dds::DomainParticipantQos& qos,
                 eprosima::fastdds::rtps::UDPv4TransportDescriptor& udp);

}  // namespace swiftlet::comms
