// Checksum of MAVLink: CRC-16/MCRF4XX (polynomial 0x1021 reflected, initial value 0xffff, no final XOR).
#pragma once

#include <cstddef>
#include <cstdint>

namespace swiftlet::mavlink {

class Crc {
 public:
  constexpr void add(std::uint8_t byte) {
    auto low = static_cast<std::uint8_t>(byte ^ (value_ & 0xffU));
    low = static_cast<std::uint8_t>(low ^ (low << 4U));
    value_ = static_cast<std::uint16_t>((value_ >> 8U) ^ (low << 8U) ^ (low << 3U) ^ (low >> 4U));
  }
  constexpr void add(const std::uint8_t* bytes, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) add(bytes[i]);
  }
  constexpr std::uint16_t value() const { return value_; }

 private:
  std::uint16_t value_ = 0xffff;
};

}  // namespace swiftlet::mavlink
