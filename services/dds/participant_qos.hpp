// The QoS of a participant: discovery, transports, name and user data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

// announced_ports: number of ports to which it announces itself with localhost_only (discovery_ports.hpp).
eprosima::fastdds::dds::DomainParticipantQos participant_qos(const NodeSettings& settings,
                                                             std::uint32_t announced_ports);

// Returns the user data of a participant that serves this vehicle (several: "kl1,kl2").
std::vector<eprosima::fastrtps::rtps::octet> user_data(const std::string& vehicle);

// Returns the vehicle that a participant's user data names (several: "kl1,kl2"); empty if none.
std::string vehicle_of(const std::vector<eprosima::fastrtps::rtps::octet>& user_data);

}  // namespace swiftlet::comms
