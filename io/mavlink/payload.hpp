// Messages to payloads and back. MAVLink is little-endian.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "swiftlet/io/mavlink/frame.hpp"

namespace swiftlet::mavlink {

// The address of a sender.
struct Address {
  std::uint8_t system_id = 0;
  std::uint8_t component_id = 0;
};

namespace payload {

template <std::size_t Size>
using Bits =
    std::conditional_t<Size == 1, std::uint8_t,
                       std::conditional_t<Size == 2, std::uint16_t,
                                          std::conditional_t<Size == 4, std::uint32_t, std::uint64_t>>>;

class Writer {
 public:
  explicit Writer(Frame& frame) : frame_(frame) {}

  void extensions() {}
  template <class Value>
  void operator()(const char*, const Value& value) {
    Bits<sizeof(Value)> bits;
    std::memcpy(&bits, &value, sizeof bits);
    for (std::size_t i = 0; i < sizeof bits; ++i)
      frame_.payload[frame_.length++] = static_cast<std::uint8_t>(bits >> (8 * i));
  }
  template <class Value, std::size_t Count>
  void operator()(const char* name, const std::array<Value, Count>& values) {
    for (const Value& value : values) (*this)(name, value);
  }

 private:
  Frame& frame_;
};

class Reader {
 public:
  explicit Reader(const Frame& frame) : frame_(frame) {}

  void extensions() {}
  template <class Value>
  void operator()(const char*, Value& value) {
    Bits<sizeof(Value)> bits = 0;
    for (std::size_t i = 0; i < sizeof bits; ++i)
      bits = static_cast<Bits<sizeof(Value)>>(bits | static_cast<Bits<sizeof(Value)>>(frame_.payload[at_++])
                                                         << (8 * i));
    std::memcpy(&value, &bits, sizeof bits);
  }
  template <class Value, std::size_t Count>
  void operator()(const char* name, std::array<Value, Count>& values) {
    for (Value& value : values) (*this)(name, value);
  }

 private:
  const Frame& frame_;
  std::size_t at_ = 0;
};

}  // namespace payload

template <class Message>
Frame to_frame(const Message& message, Address sender, std::uint8_t sequence) {
  Frame frame;
  frame.sequence = sequence;
  frame.system_id = sender.system_id;
  frame.component_id = sender.component_id;
  frame.message_id = Message::kId;
  payload::Writer writer(frame);
  Message::visit(writer, message);
  return frame;
}

// Precondition: frame.message_id is that of Message.
template <class Message>
Message from_frame(const Frame& frame) {
  Message message;
  payload::Reader reader(frame);
  Message::visit(reader, message);
  return message;
}

}  // namespace swiftlet::mavlink
