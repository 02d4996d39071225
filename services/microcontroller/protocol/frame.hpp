// Frames on a serial line or in datagrams:
//
//   0x00, COBS(kind u8, sequence u16, fields of the message, CRC-32 u32), 0x00
//
// The zero before a frame ends whatever noise was before it, so that a broken frame never takes the next one with it. CRC-32 is
// that of IEEE 802.3 and zlib: polynomial 0x04c11db7, reflected, initial value and final XOR 0xffffffff, over kind, sequence
// and fields. sequence counts all frames of one direction. No heap.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <boost/crc.hpp>

#include "swiftlet/services/microcontroller/protocol/cobs.hpp"
#include "swiftlet/services/microcontroller/protocol/layout.hpp"

namespace swiftlet::protocol {

constexpr std::size_t kHeaderSize = 3;  // kind and sequence
constexpr std::size_t kCrcSize = 4;
constexpr std::size_t kMaxFields = 160;  // bytes of the longest message
constexpr std::size_t kMaxContent = kHeaderSize + kMaxFields + kCrcSize;
constexpr std::size_t kMaxFrame = longest_cobs(kMaxContent) + 2;

inline std::uint32_t crc32(const std::uint8_t* bytes, std::size_t size) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes, size);
  return crc.checksum();
}

// A received frame; valid until the decoder takes the next byte.
struct Frame {
  std::uint8_t kind = 0;
  std::uint16_t sequence = 0;
  const std::uint8_t* fields = nullptr;
  std::size_t size = 0;
};

// The message of a frame; empty if it is of another kind or size.
template <class Message>
std::optional<Message> message_of(const Frame& frame) {
  if (frame.kind != Message::kKind || frame.size != wire_size<Message>()) return std::nullopt;
  return read_fields<Message>(frame.fields);
}

class FrameEncoder {
 public:
  struct Bytes {
    const std::uint8_t* data;  // valid until the next call
    std::size_t size;
  };

  template <class Message>
  Bytes encode(const Message& message) {
    constexpr std::size_t kFields = wire_size<Message>();
    static_assert(kFields <= kMaxFields);
    std::array<std::uint8_t, kHeaderSize + kFields + kCrcSize> content{};
    detail::Writer writer{content.data()};
    writer.put(Message::kKind);
    writer.put(sequence_++);
    write_fields(message, writer.at);
    writer.at += kFields;
    writer.put(crc32(content.data(), kHeaderSize + kFields));
    frame_[0] = 0;
    const std::size_t end = 1 + cobs_encode(content.data(), content.size(), frame_.data() + 1);
    frame_[end] = 0;
    return {frame_.data(), end + 1};
  }

 private:
  std::uint16_t sequence_ = 0;
  std::array<std::uint8_t, kMaxFrame> frame_{};
};

class FrameDecoder {
 public:
  struct Counts {
    std::uint32_t received = 0;
    std::uint32_t refused = 0;  // broken: COBS, length or CRC
    std::uint32_t lost = 0;     // missing sequence numbers
  };

  // Returns true if this byte ends a valid frame.
  bool take(std::uint8_t byte) {
    if (byte != 0) {
      if (size_ < bytes_.size()) bytes_[size_] = byte;
      ++size_;
      return false;
    }
    const std::size_t size = size_;
    size_ = 0;
    if (size == 0) return false;  // two zeros between frames
    const bool valid = size <= bytes_.size() && open(size);
    valid ? ++counts_.received : ++counts_.refused;
    return valid;
  }
  const Frame& frame() const { return frame_; }
  const Counts& counts() const { return counts_; }

  // The far end may have started again: its next sequence number follows no earlier one.
  void expect_any_sequence() { has_sequence_ = false; }

 private:
  bool open(std::size_t size) {
    const Decoded content = cobs_decode(bytes_.data(), size, bytes_.data());
    if (!content.valid || content.size < kHeaderSize + kCrcSize) return false;
    const std::size_t end = content.size - kCrcSize;
    std::uint32_t crc = 0;
    detail::Reader{bytes_.data() + end}.get(crc);
    if (crc != crc32(bytes_.data(), end)) return false;
    detail::Reader reader{bytes_.data()};
    reader.get(frame_.kind);
    reader.get(frame_.sequence);
    frame_.fields = reader.at;
    frame_.size = end - kHeaderSize;
    count_lost();
    return true;
  }

  void count_lost() {
    const auto ahead = static_cast<std::uint16_t>(frame_.sequence - sequence_);
    constexpr std::uint16_t kHalf = 0x8000;  // beyond: a datagram that was overtaken, or sent twice
    if (has_sequence_ && (ahead == 0 || ahead >= kHalf)) return;
    if (has_sequence_) counts_.lost += ahead - 1U;
    sequence_ = frame_.sequence;
    has_sequence_ = true;
  }

  std::array<std::uint8_t, longest_cobs(kMaxContent)> bytes_{};
  std::size_t size_ = 0;  // may exceed bytes_: the frame is too long
  Frame frame_;
  Counts counts_;
  bool has_sequence_ = false;
  std::uint16_t sequence_ = 0;  // of the newest frame
};

}  // namespace swiftlet::protocol
