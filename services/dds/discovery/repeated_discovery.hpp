// A transport of Fast DDS that sends each datagram of discovery several times. Discovery waits a second for a lost one that
// tells of endpoints, because Fast DDS has no setting for the heartbeats of its own endpoints; and a process from which
// another one hears nothing else is taken for dead after four lost announcements. Receivers ignore the copies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::comms {

// With half of all datagrams lost between two hosts, 98 % of those that tell of endpoints arrive, and four announcements are
// lost once in hours.
constexpr int kEndpointCopies = 6;
constexpr int kAnnouncementCopies = 4;

// True for the UDP ports to which the processes of this domain send discovery.
bool is_discovery_port(int domain, std::uint32_t port);

// True for a message of RTPS in which participants only announce themselves, or assert that they live.
bool is_announcement(const std::uint8_t* message, std::size_t size);

// Descriptor of the transport below, with such copies.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> repeat_discovery(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> below, int domain);

}  // namespace swiftlet::comms
