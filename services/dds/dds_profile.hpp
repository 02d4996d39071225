// XML profiles of Fast DDS: what a user may set of a participant, under what Swiftlet sets itself.
#pragma once

#include <string>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::dds {

struct DdsProfile {
  eprosima::fastdds::dds::DomainParticipantQos participant;
  // The transport of the profile; with the default values if it has none.
  eprosima::fastdds::rtps::UDPv4TransportDescriptor udp;
};

// Reads the participant profile of a file, the first one or that with is_default_profile="true". Takes its allocation,
// properties, sizes of socket buffers, and its first transport, which must be UDPv4. Swiftlet sets the rest itself. Throws
// io::ConfigError with file and line. Fast DDS says on stderr what it refuses. Not thread-safe.
DdsProfile load_dds_profile(const std::string& file);

}  // namespace swiftlet::dds
