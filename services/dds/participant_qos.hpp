// The QoS of a participant: discovery, transports and name.
#pragma once

#include <cstdint>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

// announced_ports: number of ports to which it announces itself without multicast (discovery_ports.hpp). Throws
// std::runtime_error for an unknown host or interface, and
// runtime::ConfigError for an invalid profile.
eprosima::fastdds::dds::DomainParticipantQos participant_qos(const NodeSettings& settings,
                                                             std::uint32_t announced_ports);

}  // namespace swiftlet::comms
