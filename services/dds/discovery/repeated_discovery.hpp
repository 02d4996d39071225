// A transport of Fast DDS that sends each datagram of discovery several times. Discovery waits a second for a lost one that
// tells of endpoints, because Fast DDS has no setting for the heartbeats of its own endpoints; and a process from which
// another one hears nothing else is taken for dead after four lost announcements. Receivers ignore the copies.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "swiftlet/services/dds/datagram/datagram_guard.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::comms {

// True for the UDP ports to which the processes of this domain send discovery.
bool is_discovery_port(int domain, std::uint32_t port);

// Of a message of RTPS in which participants only announce themselves, or assert that they live: a digest of what it says,
// without its time. nullopt: another message.
std::optional<std::uint64_t> announcement_digest(const std::uint8_t* message, std::size_t size);

// Descriptor of the transport below, with as many copies as AnnouncementBudget has for the processes that `guard` has heard;
// one at most if it loses nothing. No announcement is sent before `listening` is true: Fast DDS begins to announce a
// participant before it takes in what the others answer.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> repeat_discovery(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> below, int domain,
    std::shared_ptr<DatagramGuard> guard, std::shared_ptr<const std::atomic<bool>> listening,
    bool loses_nothing);

}  // namespace swiftlet::comms
