// A transport of Fast DDS for a discovery server, which sends only to destinations for which a channel was opened. The server
// of Fast DDS 2.9 announces itself to a client that it has entered in its database, also if it has not opened a channel for it
// yet, and fails the assertion "it != collection_.end()" then (PDPServer::announceParticipantState, PDPServerListener).
#pragma once

#include <memory>

#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::comms {

// Descriptor of a transport in front of the one below. What it does not send, the server repeats.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> send_to_opened(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> below);

}  // namespace swiftlet::comms
