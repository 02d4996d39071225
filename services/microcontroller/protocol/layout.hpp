// Writes and reads the fields of a message, little-endian and without padding, on any processor. No heap.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace swiftlet::protocol {
namespace detail {

template <class T>
struct SizeOf {
  static constexpr std::size_t value = sizeof(T);
};
template <class T, std::size_t N>
struct SizeOf<std::array<T, N>> {
  static constexpr std::size_t value = N * sizeof(T);
};

struct SizeCounter {
  std::size_t size = 0;
  template <class T>
  constexpr void operator()(const char*, const T&) {
    size += SizeOf<T>::value;
  }
};

struct Writer {
  std::uint8_t* at;

  template <class T>
  void operator()(const char*, const T& value) {
    put(value);
  }
  template <class T, std::size_t N>
  void put(const std::array<T, N>& values) {
    for (const T& value : values) put(value);
  }
  void put(float value) {
    std::uint32_t bits = 0;  // IEEE 754
    std::memcpy(&bits, &value, sizeof bits);
    put(bits);
  }
  template <class T, class = std::enable_if_t<std::is_integral_v<T>>>
  void put(T value) {
    auto bits = static_cast<std::uint64_t>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i, bits >>= 8) *at++ = static_cast<std::uint8_t>(bits & 0xffU);
  }
};

struct Reader {
  const std::uint8_t* at;

  template <class T>
  void operator()(const char*, T& value) {
    get(value);
  }
  template <class T, std::size_t N>
  void get(std::array<T, N>& values) {
    for (T& value : values) get(value);
  }
  void get(float& value) {
    std::uint32_t bits = 0;
    get(bits);
    std::memcpy(&value, &bits, sizeof bits);
  }
  template <class T, class = std::enable_if_t<std::is_integral_v<T>>>
  void get(T& value) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) bits |= static_cast<std::uint64_t>(*at++) << (8 * i);
    value = static_cast<T>(bits);
  }
};

}  // namespace detail

// Bytes of a message's fields on the wire.
template <class Message>
constexpr std::size_t wire_size() {
  const Message message{};
  detail::SizeCounter counter;
  Message::visit(message, counter);
  return counter.size;
}

// `out` has room for wire_size().
template <class Message>
void write_fields(const Message& message, std::uint8_t* out) {
  Message::visit(message, detail::Writer{out});
}

// `bytes` has wire_size() bytes.
template <class Message>
Message read_fields(const std::uint8_t* bytes) {
  Message message;
  Message::visit(message, detail::Reader{bytes});
  return message;
}

// Text of fixed length, filled up with zeros: cuts what is too long.
template <std::size_t N>
void set_text(std::array<char, N>& field, const char* text) {
  field.fill('\0');
  for (std::size_t i = 0; i < N && text[i] != '\0'; ++i) field[i] = text[i];
}

// The text of such a field, which may fill it.
template <std::size_t N>
std::string_view text_of(const std::array<char, N>& field) {
  const std::string_view all(field.data(), N);
  return all.substr(0, all.find('\0'));
}

}  // namespace swiftlet::protocol
