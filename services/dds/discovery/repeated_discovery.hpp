// A transport of Fast DDS that sends each datagram of discovery several times. Discovery waits a second or more for a lost
// datagram, because Fast DDS 2.9 has no setting for the heartbeats of its own endpoints. Receivers ignore the copies.
#pragma once

#include <cstdint>
#include <memory>

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

namespace swiftlet::comms {

// With half of all datagrams lost between two hosts, 94 % of those of discovery arrive.
constexpr int kDiscoveryCopies = 4;

// True for the UDP ports to which the processes of this domain send discovery.
bool is_discovery_port(int domain, std::uint32_t port);

// Descriptor of the transport below, with such copies.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> repeat_discovery(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> below, int domain);

}  // namespace swiftlet::comms
