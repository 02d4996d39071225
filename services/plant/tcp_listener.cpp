#include "swiftlet/services/plant/tcp_listener.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>

#include <fmt/core.h>

#include "swiftlet/io/network/sockets.hpp"

namespace swiftlet::services {

TcpListener::TcpListener(const std::string& address, int port) {
  if (in_addr digits{}; inet_pton(AF_INET, address.c_str(), &digits) != 1)
    throw std::invalid_argument(fmt::format(
        "--autopilot-address: is {}, must be an IPv4 address in digits, such as 127.0.0.1", address));
  const sockaddr_in where = io::socket_address(address, port);
  descriptor_ = io::Descriptor(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!descriptor_.is_open())
    throw std::runtime_error(fmt::format("cannot open a socket: {}", std::strerror(errno)));
  const int on = 1;
  ::setsockopt(descriptor(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (::bind(descriptor(), reinterpret_cast<const sockaddr*>(&where), sizeof where) == 0 &&
      ::listen(descriptor(), 1) == 0)
    return;
  const int error = errno;
  throw std::runtime_error(
      error == EADDRINUSE
          ? fmt::format(
                "port {} of {} is in use: end the other simulator, or choose another --autopilot-port", port,
                address)
          : fmt::format("cannot listen to port {} of {}: {}", port, address, std::strerror(error)));
}

std::unique_ptr<ByteStream> TcpListener::accept() {
  const int accepted = ::accept4(descriptor(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (accepted < 0) return nullptr;
  const int on = 1;
  ::setsockopt(accepted, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return std::make_unique<ByteStream>(accepted);
}

}  // namespace swiftlet::services
