// Reads numbers from received bytes without ever reading beyond their end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace swiftlet::io {

// The unsigned integer with the bits of a number.
template <class Number, std::size_t Size = sizeof(Number)>
using BitsOf =
    std::conditional_t<Size == 1, std::uint8_t,
                       std::conditional_t<Size == 2, std::uint16_t,
                                          std::conditional_t<Size == 4, std::uint32_t, std::uint64_t>>>;

// A read beyond the end returns zeros and makes ok() false for good, so that a sequence of reads needs one check.
class ByteReader {
 public:
  ByteReader(const std::uint8_t* data, std::size_t size, bool little_endian)
      : data_(data), size_(size), little_endian_(little_endian) {}

  bool ok() const { return ok_; }
  bool little_endian() const { return little_endian_; }
  std::size_t rest() const { return size_; }  // bytes
  const std::uint8_t* data() const { return data_; }

  // An integer, or a floating-point number of IEEE 754.
  template <class Number>
  Number number() {
    const auto bits = static_cast<BitsOf<Number>>(integer(sizeof(Number)));
    Number value;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }
  std::uint8_t u8() { return number<std::uint8_t>(); }
  std::uint16_t u16() { return number<std::uint16_t>(); }
  std::uint32_t u32() { return number<std::uint32_t>(); }
  std::uint64_t u64() { return number<std::uint64_t>(); }
  std::int32_t i32() { return number<std::int32_t>(); }
  float f32() { return number<float>(); }
  double f64() { return number<double>(); }
  // A text that ends with a NUL, which is skipped. Without one in the rest the read is beyond the end.
  std::string_view text() {
    const void* const end = size_ == 0 ? nullptr : std::memchr(data_, 0, size_);
    if (end == nullptr) {
      take(size_ + 1);
      return {};
    }
    const auto length = static_cast<std::size_t>(static_cast<const std::uint8_t*>(end) - data_);
    const std::uint8_t* const taken = take(length + 1);
    return {reinterpret_cast<const char*>(taken), length};
  }
  // A field of this size: the text up to its first NUL.
  std::string_view text_field(std::size_t bytes) {
    const std::uint8_t* const taken = take(bytes);
    if (taken == nullptr) return {};
    const std::string_view field(reinterpret_cast<const char*>(taken), bytes);
    return field.substr(0, field.find('\0'));
  }
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
  std::uint64_t integer(std::size_t bytes) {
    const std::uint8_t* const taken = take(bytes);
    if (taken == nullptr) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value = value << 8U | taken[little_endian_ ? bytes - 1 - i : i];
    return value;
  }

  const std::uint8_t* data_;
  std::size_t size_;
  bool little_endian_;
  bool ok_ = true;
};

}  // namespace swiftlet::io
