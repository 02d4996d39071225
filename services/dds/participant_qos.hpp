// How a node joins the network: discovery, transports, name and user data.
#pragma once

#include <string>
#include <vector>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

// Of a process that joins now. Throws std::runtime_error with a sentence if the domain is full.
eprosima::fastdds::dds::DomainParticipantQos participant_qos(const NodeSettings& settings);

// The vehicle that a participant's user data names; empty if it names none.
std::string vehicle_of(const std::vector<eprosima::fastrtps::rtps::octet>& user_data);

}  // namespace swiftlet::comms
