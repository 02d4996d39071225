// XML profiles of Fast DDS: what a user may set of a participant, under what Swiftlet sets itself.
#pragma once

#include <string>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::comms {

struct DdsProfile {
  eprosima::fastdds::dds::DomainParticipantQos participant;
  // The transport of the profile; with the default values if it has none.
  eprosima::fastdds::rtps::UDPv4TransportDescriptor udp;
};

// Reads the participant profile of a file: the only one, or that with is_default_profile="true". It may set
//   rtps: allocation, sendSocketBufferSize, listenSocketBufferSize, propertiesPolicy, userTransports with one UDPv4 transport
//   transport_descriptor: sendBufferSize, receiveBufferSize, TTL, maxMessageSize, output_port, interfaceWhiteList
// Throws runtime::ConfigError with file, line and element for everything else, and for what Fast DDS refuses.
DdsProfile load_dds_profile(const std::string& file);

}  // namespace swiftlet::comms
