// A TCP connection or a serial port: bytes in both directions, without waiting.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "swiftlet/io/descriptor.hpp"

namespace swiftlet::services {

class ByteStream {
 public:
  // Owns the descriptor, which must not block.
  explicit ByteStream(int descriptor) : descriptor_(descriptor) {}

  // Sends all bytes or none: none while the far end has not accepted those before. Returns false for none.
  bool send(const std::uint8_t* bytes, std::size_t size);
  // Returns the number of bytes received, 0 if there are none.
  std::size_t receive(std::uint8_t* bytes, std::size_t size);

  bool closed() const { return closed_; }  // by the far end, or by an error of the link
  int descriptor() const { return descriptor_.get(); }

 private:
  std::size_t write(const std::uint8_t* bytes, std::size_t size);

  io::Descriptor descriptor_;
  bool closed_ = false;
  std::vector<std::uint8_t> rest_;  // of the last message
};

}  // namespace swiftlet::services
