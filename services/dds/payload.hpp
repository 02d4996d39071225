// Messages as their payloads: CDR with the encapsulation header.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::dds {

// For each message of a topic. Allocates.
template <class T>
std::vector<std::uint8_t> to_payload(const T& message);

// Returns false, with a message in any state, if the payload is not one. Checks no values: from_message() does.
template <class T>
bool from_payload(const std::uint8_t* payload, std::size_t size, T& message);

}  // namespace swiftlet::dds
