// The UDP object stream of Vicon Tracker. Tracker sends it to this host; nothing is asked for.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/io/mocap/vicon.hpp"
#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/services/mocap/sources/source.hpp"

namespace swiftlet::mocap {

// The stream has no stamps: a frame was exposed `latency_s` of the room before its arrival. Room::server may name who is
// received, and the port on which: HOST:PORT. Otherwise the first that sends is, until it is silent for a second.
class ViconSource final : public Source {
 public:
  explicit ViconSource(const Room& room);

  bool receive(SourceFrame& frame, std::chrono::milliseconds timeout) override;
  std::string description() const override;
  std::uint16_t port() const { return socket_.port(); }

 private:
  using Time = std::chrono::steady_clock::time_point;

  bool is_from_server(const io::Endpoint& from, Time now);
  bool follows(std::uint32_t number);
  bool take(std::int64_t arrived_ns, SourceFrame& frame);

  const std::int64_t latency_ns_;
  const std::optional<io::Endpoint> chosen_;
  io::UdpSocket socket_;
  std::optional<io::Endpoint> server_;
  Time heard_;
  std::optional<std::uint32_t> last_number_;
  vicon::Frame frame_;
  std::vector<std::uint8_t> datagram_;
};

}  // namespace swiftlet::mocap
