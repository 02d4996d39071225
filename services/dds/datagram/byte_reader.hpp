// Reads integers from received bytes without ever reading beyond their end.
#pragma once

#include <cstddef>
#include <cstdint>

namespace swiftlet::comms {

// A read beyond the end returns zeros and makes ok() false for good, so that a sequence of reads needs one check.
class ByteReader {
 public:
  ByteReader(const std::uint8_t* data, std::size_t size, bool little_endian)
      : data_(data), size_(size), little_endian_(little_endian) {}

  bool ok() const { return ok_; }
  bool little_endian() const { return little_endian_; }
  std::size_t rest() const { return size_; }  // bytes
  const std::uint8_t* data() const { return data_; }

  std::uint8_t u8() { return static_cast<std::uint8_t>(integer(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(integer(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(integer(4)); }
  void skip(std::size_t bytes) { take(bytes); }
  // Returns the next bytes, nullptr if there are not as many.
  const std::uint8_t* take(std::size_t bytes) {
    if (bytes > size_) {
      ok_ = false;
      size_ = 0;
      return nullptr;
    }
    const std::uint8_t* const taken = data_;
    data_ += bytes;
    size_ -= bytes;
    return taken;
  }
  // Returns a reader of the next bytes; it is not ok() if there are not as many.
  ByteReader part(std::size_t bytes) {
    ByteReader part(data_, bytes <= size_ ? bytes : 0, little_endian_);
    if (take(bytes) == nullptr) part.ok_ = false;
    return part;
  }

 private:
  std::uint32_t integer(std::size_t bytes) {
    const std::uint8_t* const taken = take(bytes);
    if (taken == nullptr) return 0;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value = value << 8U | taken[little_endian_ ? bytes - 1 - i : i];
    return value;
  }

  const std::uint8_t* data_;
  std::size_t size_;
  bool little_endian_;
  bool ok_ = true;
};

}  // namespace swiftlet::comms
