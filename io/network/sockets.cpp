#include "swiftlet/io/network/sockets.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <cstring>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>

#include "swiftlet/io/network/host_address.hpp"
#include "swiftlet/io/network/interfaces.hpp"

namespace swiftlet::io {
namespace {

constexpr std::size_t kLargestDatagram = 65'536;
constexpr std::size_t kTcpChunk = 65'536;
constexpr int kReceiveBuffer = 1 << 20;

sockaddr_in address_of(std::uint32_t address, std::uint16_t port) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_port = htons(port);
  out.sin_addr.s_addr = htonl(address);
  return out;
}

std::uint32_t number_of(const std::string& ipv4) {
  in_addr address{};
  ::inet_pton(AF_INET, ipv4.c_str(), &address);
  return ntohl(address.s_addr);
}

void set(int fd, int level, int option, int value) { ::setsockopt(fd, level, option, &value, sizeof value); }

sockaddr_in local_address_of(int fd) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  return address;
}

}  // namespace

sockaddr_in socket_address(const std::string& ipv4, int port) {
  if (in_addr digits{}; !ipv4.empty() && ::inet_pton(AF_INET, ipv4.c_str(), &digits) != 1)
    throw std::runtime_error("'" + ipv4 + "' is no IPv4 address");
  return address_of(ipv4.empty() ? INADDR_ANY : number_of(ipv4), static_cast<std::uint16_t>(port));
}

std::string Endpoint::address_text() const {
  in_addr raw{};
  raw.s_addr = htonl(address);
  char text[INET_ADDRSTRLEN] = {};
  ::inet_ntop(AF_INET, &raw, text, sizeof text);
  return text;
}

std::string Endpoint::to_string() const { return address_text() + ":" + std::to_string(port); }

Endpoint resolve(const std::string& text, std::uint16_t default_port) {
  const std::string fault = fault_of_host_address(text);
  if (!fault.empty()) throw std::invalid_argument("server: " + fault);
  const HostAddress host = parse_host_address(text);
  try {
    return {number_of(ipv4_addresses_of(host.host).front()), host.port == 0 ? default_port : host.port};
  } catch (const std::runtime_error& error) {
    throw std::invalid_argument(std::string("server: ") + error.what());
  }
}

std::string interface_address(const std::string& name_or_address) {
  if (name_or_address.empty()) return "";
  const std::string fault = fault_of_interface(name_or_address);
  if (!fault.empty()) throw std::invalid_argument("interface: " + fault);
  return addresses_of_interfaces({name_or_address}).front();
}

UdpSocket::UdpSocket(const std::string& interface, std::uint16_t port, bool shared)
    : descriptor_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  if (shared) set(fd(), SOL_SOCKET, SO_REUSEADDR, 1);
  set(fd(), SOL_SOCKET, SO_BROADCAST, 1);
  set(fd(), SOL_SOCKET, SO_RCVBUF, kReceiveBuffer);
  const sockaddr_in address = socket_address(interface, port);
  if (fd() >= 0 && ::bind(fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return;
  throw std::runtime_error("cannot receive on UDP port " + std::to_string(port) + ": " +
                           std::strerror(errno));
}

void UdpSocket::join(const std::string& group, const std::string& interface) {
  ip_mreq request{};
  request.imr_multiaddr.s_addr = htonl(number_of(group));
  request.imr_interface.s_addr = htonl(interface.empty() ? INADDR_ANY : number_of(interface));
  if (::setsockopt(fd(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request) == 0) return;
  throw std::runtime_error("cannot join the multicast group " + group +
                           (interface.empty() ? "" : " on " + interface) + ": " + std::strerror(errno));
}

bool UdpSocket::send(const std::vector<std::uint8_t>& datagram, const Endpoint& to) const {
  const sockaddr_in address = address_of(to.address, to.port);
  return ::sendto(fd(), datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&address),
                  sizeof address) == static_cast<ssize_t>(datagram.size());
}

std::optional<Endpoint> UdpSocket::receive(std::vector<std::uint8_t>& datagram) const {
  datagram.resize(kLargestDatagram);
  sockaddr_in from{};
  socklen_t size = sizeof from;
  ssize_t bytes = -1;
  do {  // an earlier datagram to a closed port is reported as an error of this call
    bytes = ::recvfrom(fd(), datagram.data(), datagram.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
  } while (bytes < 0 && (errno == EINTR || errno == ECONNREFUSED));
  datagram.resize(bytes < 0 ? 0 : static_cast<std::size_t>(bytes));
  if (bytes < 0) return std::nullopt;
  return Endpoint{ntohl(from.sin_addr.s_addr), ntohs(from.sin_port)};
}

std::uint16_t UdpSocket::port() const { return ntohs(local_address_of(fd()).sin_port); }

void TcpSocket::connect(const Endpoint& to) {
  descriptor_ = Descriptor(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  set(fd(), IPPROTO_TCP, TCP_NODELAY, 1);
  const sockaddr_in address = address_of(to.address, to.port);
  const int result = ::connect(fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  state_ = State::kConnecting;
  if (result < 0 && errno != EINPROGRESS) close();
}

TcpSocket::State TcpSocket::state() {
  if (state_ != State::kConnecting) return state_;
  pollfd request{fd(), POLLOUT, 0};
  if (::poll(&request, 1, 0) <= 0) return state_;
  int error = 0;
  socklen_t size = sizeof error;
  ::getsockopt(fd(), SOL_SOCKET, SO_ERROR, &error, &size);
  if (error != 0) {
    close();
  } else {
    state_ = State::kOpen;
  }
  return state_;
}

bool TcpSocket::send(const std::vector<std::uint8_t>& bytes) {
  // What is sent is short: a connection that does not take it is broken.
  if (::send(fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size()))
    return true;
  close();
  return false;
}

bool TcpSocket::receive(std::vector<std::uint8_t>& bytes) {
  const std::size_t before = bytes.size();
  bytes.resize(before + kTcpChunk);
  const ssize_t received = ::recv(fd(), bytes.data() + before, kTcpChunk, 0);
  bytes.resize(before + (received > 0 ? static_cast<std::size_t>(received) : 0));
  if (received > 0 || (received < 0 && (errno == EAGAIN || errno == EINTR))) return true;
  close();
  return false;
}

void TcpSocket::close() {
  descriptor_.close();
  state_ = State::kClosed;
}

std::string TcpSocket::local_address() const {
  return Endpoint{ntohl(local_address_of(fd()).sin_addr.s_addr), 0}.address_text();
}

void wait_for_input(std::initializer_list<int> descriptors, std::chrono::milliseconds timeout) {
  std::vector<pollfd> requests;
  for (const int fd : descriptors) {
    if (fd >= 0) requests.push_back({fd, POLLIN, 0});
  }
  ::poll(requests.data(), requests.size(), static_cast<int>(timeout.count()));
}

}  // namespace swiftlet::io
