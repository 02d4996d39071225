#include "swiftlet/services/vehicle_template/byte_link.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>

#include "swiftlet/io/network/host_address.hpp"
#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/services/runtime/serial_device.hpp"

namespace swiftlet::services {

ByteLink::ByteLink(ByteLinkSettings settings) : settings_(std::move(settings)) {
  if (settings_.device.empty() == settings_.udp.empty())
    throw std::invalid_argument("the link: give either --device or --udp");
  if (!settings_.device.empty()) {
    const std::string fault = runtime::fault_of_baud(settings_.baud);
    if (!fault.empty()) throw std::invalid_argument("--baud: " + fault);
    return;
  }
  const std::string fault = io::fault_of_host_address(settings_.udp);
  if (!fault.empty()) throw std::invalid_argument("--udp: " + fault);
  const io::HostAddress address = io::parse_host_address(settings_.udp);
  if (address.port == 0)
    throw std::invalid_argument("--udp: is '" + settings_.udp + "', must be HOST:PORT, with a port");
  far_end_ = io::socket_address(io::ipv4_addresses_of(address.host).front(), address.port);
}

int ByteLink::open() noexcept {
  close();
  const int fault = settings_.device.empty() ? open_socket() : open_device();
  if (fault != 0) close();
  return fault;
}

int ByteLink::open_device() noexcept {
  const int opened = runtime::open_serial_device(settings_.device.c_str(), settings_.baud);
  descriptor_ = io::Descriptor(opened);
  return opened < 0 ? -opened : 0;
}

int ByteLink::open_socket() noexcept {
  descriptor_ = io::Descriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!is_open()) return errno;
  // Connected: only datagrams of the microcontroller are received.
  const auto* const address = reinterpret_cast<const sockaddr*>(&far_end_);
  return ::connect(descriptor(), address, sizeof far_end_) == 0 ? 0 : errno;
}

std::size_t ByteLink::read(std::uint8_t* bytes, std::size_t room) noexcept {
  if (!is_open()) return 0;
  const ssize_t count = ::read(descriptor(), bytes, room);
  if (count > 0) return static_cast<std::size_t>(count);
  const bool is_only_empty = count < 0 && (errno == EAGAIN || errno == EINTR);
  if (settings_.device.empty() || is_only_empty) return 0;  // of UDP: the far end is not there yet
  close();
  return 0;
}

bool ByteLink::write(const std::uint8_t* bytes, std::size_t size) noexcept {
  return is_open() && ::write(descriptor(), bytes, size) == static_cast<ssize_t>(size);
}

}  // namespace swiftlet::services
