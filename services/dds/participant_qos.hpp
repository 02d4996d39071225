// The QoS of a participant: discovery, transport and name.
#pragma once

#include <cstdint>
#include <memory>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "swiftlet/services/dds/datagram/datagram_guard.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

// announced_ports: number of ports to which it announces itself without multicast (discovery_ports.hpp).
// guard: checks the datagrams that it receives. Throws std::runtime_error for an unknown host or interface, and
// runtime::ConfigError for an invalid profile.
eprosima::fastdds::dds::DomainParticipantQos participant_qos(const NodeSettings& settings,
                                                             std::uint32_t announced_ports,
                                                             const std::shared_ptr<DatagramGuard>& guard);

}  // namespace swiftlet::comms
