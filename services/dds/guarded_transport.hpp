// The transport of Fast DDS through which everything passes: it checks each received datagram before the middleware parses it,
// seals what is sent, and sends discovery several times.
#pragma once

#include <memory>
#include <optional>

#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/rtps/datagram_guard.hpp"

namespace swiftlet::dds {

using TransportDescriptor = std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>;

// A descriptor of the transport before UDP. domain: of a participant, which sends each datagram of its discovery several times
// (repeated_discovery.hpp). nullopt: of a discovery server, which also sends to places for which no channel was opened.
TransportDescriptor guarded(const eprosima::fastdds::rtps::UDPv4TransportDescriptor& udp,
                            std::shared_ptr<rtps::DatagramGuard> guard, std::optional<int> domain);

}  // namespace swiftlet::dds
