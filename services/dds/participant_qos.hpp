// The QoS of a participant: discovery, transports and name.
#pragma once

#include <cstdint>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

// announced_ports: number of ports to which it announces itself with localhost_only (discovery_ports.hpp).
eprosima::fastdds::dds::DomainParticipantQos participant_qos(const NodeSettings& settings,
                                                             std::uint32_t announced_ports);

}  // namespace swiftlet::comms
