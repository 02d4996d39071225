// Writes numbers as bytes, in the same order on any processor. io::ByteReader reads them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "swiftlet/io/byte_reader.hpp"

namespace swiftlet::io {

// number: an integer, an enumerator, or a floating-point number of IEEE 754. `out` has room for its size.
template <class Number>
void store(Number number, std::uint8_t* out, bool little_endian = true) {
  BitsOf<Number> bits = 0;
  std::memcpy(&bits, &number, sizeof(bits));
  for (std::size_t i = 0; i < sizeof(bits); ++i)
    out[little_endian ? i : sizeof(bits) - 1 - i] = static_cast<std::uint8_t>(bits >> 8U * i);
}

// Bytes: a vector of bytes, or a string.
template <class Bytes, class Number>
void append(Bytes& out, Number number, bool little_endian = true) {
  std::array<std::uint8_t, sizeof(Number)> bytes{};
  store(number, bytes.data(), little_endian);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace swiftlet::io
