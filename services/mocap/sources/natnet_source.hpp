// A NatNet server: OptiTrack's Motive, by multicast or unicast.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/services/mocap/sources/natnet_session.hpp"
#include "swiftlet/services/mocap/sources/source.hpp"

namespace swiftlet::mocap {

struct FoundServer {
  io::Endpoint at;
  natnet::ServerInfo info;
};

// Asks these addresses, which may be a broadcast address, which NatNet servers there are.
std::vector<FoundServer> find_natnet_servers(const std::vector<io::Endpoint>& addresses,
                                             const std::string& interface, std::chrono::milliseconds time);
// The only one of them. Throws std::runtime_error that names all if they are several, or if there is none.
FoundServer only_server(const std::vector<FoundServer>& servers);

class NatNetSource final : public Source {
 public:
  explicit NatNetSource(const Room& room);

  bool receive(SourceFrame& frame, std::chrono::milliseconds timeout) override;
  std::string description() const override;
  const NatNetSession& session() const { return session_; }
  std::uint16_t command_port() const { return commands_.port(); }

 private:
  using Time = std::chrono::steady_clock::time_point;

  void ask(Time now);
  // Reads what waits in a socket; true: a frame.
  bool read(const io::UdpSocket& socket, SourceFrame& frame);
  bool take(std::int64_t arrived_ns, SourceFrame& frame);
  void meet_server();
  void fill(SourceFrame& frame, std::int64_t arrived_ns);

  const std::string interface_;
  const std::int64_t latency_ns_;
  io::Endpoint server_;
  io::UdpSocket commands_;             // also receives the frames of unicast
  std::optional<io::UdpSocket> data_;  // of multicast
  NatNetSession session_;
  std::vector<std::uint8_t> datagram_;
  bool has_new_server_ = false;
  bool is_met_ = false;
  int unanswered_echoes_ = 0;
  Time connect_due_, models_due_, echo_due_, keep_alive_due_, silent_since_;
};

}  // namespace swiftlet::mocap
