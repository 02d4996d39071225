// IPv4 sockets that never block.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <netinet/in.h>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/io/descriptor.hpp"

namespace swiftlet::io {

struct Endpoint {
  std::uint32_t address = 0;  // as a number
  std::uint16_t port = 0;

  std::string address_text() const;  // "192.168.0.106"
  std::string to_string() const;     // "192.168.0.106:1510"
};

// HOST or HOST:PORT; without a port, default_port. Throws std::invalid_argument with a sentence if the text is none or the
// host is unknown.
Endpoint resolve(const std::string& text, std::uint16_t default_port);
// The address of an interface of this host, by name or address; "": any. Throws std::invalid_argument.
std::string interface_address(const std::string& name_or_address);

// For the system's calls. ipv4: in digits; empty: any. Throws std::runtime_error with a sentence.
sockaddr_in socket_address(const std::string& ipv4, int port);

class UdpSocket {
 public:
  // interface: address to bind to; "": any. port 0: one that is free. shared: others of this host may bind it too.
  // Throws std::runtime_error with a sentence.
  UdpSocket(const std::string& interface, std::uint16_t port, bool shared = false);

  // Receives a multicast group on an interface, by its address; "": the system's choice.
  void join(const std::string& group, const std::string& interface);
  bool send(const std::vector<std::uint8_t>& datagram, const Endpoint& to) const;
  // The next datagram that waits; nullopt: none.
  std::optional<Endpoint> receive(std::vector<std::uint8_t>& datagram) const;

  std::uint16_t port() const;
  int fd() const { return descriptor_.get(); }

 private:
  Descriptor descriptor_;
};

// A connection of a client.
class TcpSocket {
 public:
  enum class State { kClosed, kConnecting, kOpen };

  void connect(const Endpoint& to);
  State state();
  bool send(const std::vector<std::uint8_t>& bytes);
  // Appends what waits; false: the other side has closed, and so has this.
  bool receive(std::vector<std::uint8_t>& bytes);
  void close();

  int fd() const { return descriptor_.get(); }
  std::string local_address() const;

 private:
  Descriptor descriptor_;
  State state_ = State::kClosed;
};

// Waits until one of the sockets has something to read, or the timeout. Descriptors below 0 are left out.
void wait_for_input(std::initializer_list<int> descriptors, std::chrono::milliseconds timeout);

}  // namespace swiftlet::io
