// A transport of Fast DDS that checks each received datagram before the middleware parses it.
#pragma once

#include <memory>

#include "swiftlet/services/dds/datagram/datagram_guard.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::comms {

using TransportDescriptor = std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>;

// A descriptor of the transport with such a check in front. opens_places: sends to places for which no channel was opened, too.
TransportDescriptor guarded(const eprosima::fastdds::rtps::UDPv4TransportDescriptor& udp,
                            std::shared_ptr<DatagramGuard> guard, bool opens_places = false);

}  // namespace swiftlet::comms
