// Frames of MAVLink 2, and of MAVLink 1 for receiving: https://mavlink.io/en/guide/serialization.html.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace swiftlet::mavlink {

constexpr std::size_t kLongestPayload = 255;
constexpr std::size_t kLongestFrame = 10 + kLongestPayload + 2 + 13;  // header, payload, checksum, signature

struct Frame {
  std::uint8_t version = 2;  // 1 or 2
  std::uint8_t sequence = 0;
  std::uint8_t system_id = 0;
  std::uint8_t component_id = 0;
  std::uint32_t message_id = 0;                         // 24 bits
  std::uint8_t length = 0;                              // of the payload, bytes
  std::array<std::uint8_t, kLongestPayload> payload{};  // 0 after `length`: fields that were cut off are 0
};

// A frame as sent.
struct FrameBytes {
  std::array<std::uint8_t, kLongestFrame> data{};
  std::size_t size = 0;
};

// Encodes as MAVLink 2, whatever frame.version says: zeros at the end of the payload are cut off, without a
// signature. crc_extra: of the message.
FrameBytes encode(const Frame& frame, std::uint8_t crc_extra);

}  // namespace swiftlet::mavlink
