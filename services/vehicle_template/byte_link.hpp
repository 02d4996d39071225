// The host's end of a link: a serial device or a UDP socket. It may vanish and come back. Nothing here waits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <netinet/in.h>
#include <string>

#include "swiftlet/io/descriptor.hpp"

namespace swiftlet::services {

struct ByteLinkSettings {
  std::string device;  // "/dev/ttyACM0"; empty: UDP
  int baud = 921'600;  // of the device; see runtime::fault_of_baud()
  std::string udp;     // HOST:PORT of the microcontroller

  const std::string& name() const { return device.empty() ? udp : device; }
};

// One thread. It does not allocate after construction.
class ByteLink {
 public:
  // Throws std::invalid_argument for settings that cannot be, std::runtime_error for an unknown host.
  explicit ByteLink(ByteLinkSettings settings);

  // Opens it, without the bytes that were received before. Returns 0, or the errno of the fault: EBUSY if another vehicle
  // process has the device.
  int open() noexcept;
  void close() noexcept { descriptor_.close(); }
  bool is_open() const noexcept { return descriptor_.is_open(); }
  int descriptor() const noexcept { return descriptor_.get(); }  // for poll(); -1 while it is closed

  // Returns the number of bytes read, 0 if there are none. Closes a link that has vanished.
  std::size_t read(std::uint8_t* bytes, std::size_t room) noexcept;
  // Bytes that the link cannot take now are lost. Returns false then.
  bool write(const std::uint8_t* bytes, std::size_t size) noexcept;

 private:
  int open_device() noexcept;
  int open_socket() noexcept;

  const ByteLinkSettings settings_;
  sockaddr_in far_end_{};
  io::Descriptor descriptor_;
};

}  // namespace swiftlet::services
