// Accepts TCP connections at an address and port.
#pragma once

#include <memory>
#include <string>

#include "swiftlet/services/plant/byte_stream.hpp"

namespace swiftlet::services {

class TcpListener {
 public:
  // address: IPv4, in digits. Throws std::runtime_error if the port cannot be listened to, std::invalid_argument
  // if the address is none.
  TcpListener(const std::string& address, int port);

  // The next waiting connection, which sends without delay; null if there is none.
  std::unique_ptr<ByteStream> accept();
  int descriptor() const { return descriptor_.get(); }

 private:
  io::Descriptor descriptor_;
};

}  // namespace swiftlet::services
