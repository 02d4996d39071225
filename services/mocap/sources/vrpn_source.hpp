// A VRPN server with any number of trackers.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/io/mocap/vrpn.hpp"
#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/services/mocap/sources/server_clock.hpp"
#include "swiftlet/services/mocap/sources/source.hpp"

namespace swiftlet::mocap {

// The stamps of the poses are translated from the server's clock, which answers pings. They are times of the exposure only as far
// as the server makes them so: what is missing is `latency_s` of the room. Each pose is a frame.
class VrpnSource final : public Source {
 public:
  explicit VrpnSource(const Room& room);

  bool receive(SourceFrame& frame, std::chrono::milliseconds timeout) override;
  std::string description() const override;

 private:
  using Time = std::chrono::steady_clock::time_point;
  enum class Stage { kClosed, kConnecting, kCookie, kConnected };

  // When something is to be done, even if nothing arrives.
  Time due() const;
  void connect_if_due(Time now);
  void advance(Time now);
  void begin();
  void lose(const std::string& why);
  void ping_if_due(Time now);
  bool take_cookie();
  bool read_udp(SourceFrame& frame);
  bool read_tcp(SourceFrame& frame);
  // Takes the messages of a buffer from `begin` on, until one is a pose.
  bool take_messages(const std::vector<std::uint8_t>& bytes, std::size_t& begin, bool is_stream,
                     SourceFrame& frame);
  bool take(const vrpn::Message& message, SourceFrame& frame);
  void take_description(const vrpn::Message& message);
  void take_pong(const vrpn::Message& message);
  bool take_pose(const vrpn::Message& message, SourceFrame& frame);
  void count_lost(std::uint32_t sequence);

  const std::int64_t latency_ns_;
  const io::Endpoint server_;
  io::UdpSocket udp_;
  io::TcpSocket tcp_;
  Stage stage_ = Stage::kClosed;
  bool was_connected_ = false;
  std::string fault_;  // why there is no connection
  Time connect_due_, heard_, ping_due_;

  std::vector<std::uint8_t> stream_;  // of TCP, not yet taken
  std::size_t stream_begin_ = 0;
  std::vector<std::uint8_t> datagram_;
  std::size_t datagram_begin_ = 0;

  std::map<std::int32_t, std::string> senders_, types_;  // as the server numbers them
  std::map<std::size_t, std::int64_t> last_stamps_;      // of each body
  std::optional<std::int32_t> tracker_;                  // a sender of poses: it answers pings
  std::uint32_t last_sequence_ = 0;
  std::optional<std::int64_t> pinged_ns_;  // host's clock, until it is answered
  int unanswered_pings_ = 0;
  ServerClock clock_;
};

}  // namespace swiftlet::mocap
