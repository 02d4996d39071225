// Consistent Overhead Byte Stuffing: bytes without a zero, so that a zero can separate frames. Cheshire and Baker,
// "Consistent Overhead Byte Stuffing", IEEE/ACM Transactions on Networking 7 (1999). No heap, no dependencies.
#pragma once

#include <cstddef>
#include <cstdint>

namespace swiftlet::protocol {

// Most bytes that cobs_encode() writes for `size` bytes.
constexpr std::size_t longest_cobs(std::size_t size) { return size + size / 254 + 1; }

// Writes the bytes without zeros. `out` has room for longest_cobs(size) and does not overlap `bytes`. Returns the number
// of bytes written.
inline std::size_t cobs_encode(const std::uint8_t* bytes, std::size_t size, std::uint8_t* out) {
  std::size_t code_at = 0;  // each block begins with its code: the distance to the next zero
  std::size_t end = 1;
  std::uint8_t code = 1;
  const auto end_block = [&] {
    out[code_at] = code;
    code_at = end++;
    code = 1;
  };
  for (std::size_t i = 0; i < size; ++i) {
    if (bytes[i] == 0) {
      end_block();
      continue;
    }
    out[end++] = bytes[i];
    if (++code == 0xff) end_block();
  }
  out[code_at] = code;
  return end;
}

struct Decoded {
  bool valid = false;
  std::size_t size = 0;  // bytes written
};

// The inverse. `out` has room for `size` bytes, and may be `bytes`: a decoded byte is never behind its source.
inline Decoded cobs_decode(const std::uint8_t* bytes, std::size_t size, std::uint8_t* out) {
  std::size_t end = 0;
  for (std::size_t at = 0; at < size;) {
    const std::uint8_t code = bytes[at++];
    if (code == 0 || code - 1U > size - at) return {};
    for (std::size_t i = 1; i < code; ++i) {
      if (bytes[at] == 0) return {};
      out[end++] = bytes[at++];
    }
    if (code != 0xff && at < size) out[end++] = 0;
  }
  return {true, end};
}

}  // namespace swiftlet::protocol
