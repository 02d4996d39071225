// The microcontroller's end of the link: a pseudo-terminal or a UDP port. Nothing here waits but wait_until().
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace swiftlet::services {

class Port {
 public:
  virtual ~Port() = default;
  // Waits for bytes until this monotonic time. Returns true if there are some.
  bool wait_until(std::int64_t until_ns) const;
  // Returns the number of bytes read, 0 if there are none.
  virtual std::size_t read(std::uint8_t* bytes, std::size_t room) = 0;
  // Bytes that nobody takes are lost.
  virtual void write(const std::uint8_t* bytes, std::size_t size) = 0;
  // The bytes of the last read() held no valid frame: whoever sent them is not the host.
  virtual void refuse_sender() {}

 protected:
  virtual int descriptor() const = 0;
};

// A pseudo-terminal. `link` becomes a symbolic link to the device that a host opens, as long as the port lives. Throws
// std::invalid_argument if `link` exists and is no symbolic link, std::runtime_error if the system refuses.
std::unique_ptr<Port> open_pseudo_terminal(const std::filesystem::path& link);

// A UDP port that sends to whoever sent the last valid frame. address: HOST:PORT of this computer. Throws
// std::invalid_argument if it cannot be read, std::runtime_error if the system refuses.
std::unique_ptr<Port> open_udp_port(const std::string& address);

}  // namespace swiftlet::services
