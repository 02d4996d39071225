// The version of the messages, which vehicle_info and control_status state: a process refuses another one by a sentence.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "swiftlet_msgs/msg/VehicleInfo.h"

#include "swiftlet/io/byte_reader.hpp"

namespace swiftlet::messages {

constexpr std::uint32_t kWireVersion = swiftlet_msgs::msg::VehicleInfo_Constants::WIRE_VERSION;

template <class Message, class = void>
struct StatesWireVersion : std::false_type {};
template <class Message>
struct StatesWireVersion<Message, std::void_t<decltype(std::declval<const Message&>().wire_version())>>
    : std::true_type {};

// The version in a payload in CDR, with its encapsulation header, of a message that begins with wire_version. nullopt: the
// payload is too short.
inline std::optional<std::uint32_t> wire_version_of(const std::uint8_t* payload, std::size_t size) {
  constexpr std::size_t kHeader = 4;
  if (size < kHeader + sizeof(std::uint32_t)) return std::nullopt;
  return io::ByteReader(payload + kHeader, sizeof(std::uint32_t), (payload[1] & 1U) != 0).u32();
}

// "the vehicle speaks another version of the messages than this program, 2"; empty: it speaks the same one.
inline std::string fault_of_wire_version(std::uint32_t version, const char* who) {
  if (version == kWireVersion) return {};
  const std::string own = std::to_string(kWireVersion);
  constexpr std::uint32_t kPlausible = 1000;  // version 1 had no such member: a time stands there
  if (version == 0 || version > kPlausible)
    return std::string(who) + " speaks another version of the messages than this program, " + own;
  return std::string(who) + " speaks version " + std::to_string(version) + " of the messages, this program " +
         own;
}

}  // namespace swiftlet::messages
