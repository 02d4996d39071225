// Messages to payloads and back. MAVLink is little-endian.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "swiftlet/io/byte_writer.hpp"
#include "swiftlet/io/mavlink/frame.hpp"

namespace swiftlet::mavlink {

// The address of a sender.
struct Address {
  std::uint8_t system_id = 0;
  std::uint8_t component_id = 0;
};

namespace payload {

class Writer {
 public:
  explicit Writer(Frame& frame) : frame_(frame) {}

  void extensions() {}
  template <class Value>
  void operator()(const char*, const Value& value) {
    io::store(value, &frame_.payload.at(frame_.length));
    frame_.length = static_cast<std::uint8_t>(frame_.length + sizeof(value));
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
  explicit Reader(const Frame& frame) : in_(frame.payload.data(), frame.payload.size(), true) {}

  void extensions() {}
  template <class Value>
  void operator()(const char*, Value& value) {
    value = in_.number<Value>();
  }
  template <class Value, std::size_t Count>
  void operator()(const char* name, std::array<Value, Count>& values) {
    for (Value& value : values) (*this)(name, value);
  }

 private:
  io::ByteReader in_;
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
