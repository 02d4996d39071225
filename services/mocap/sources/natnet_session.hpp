// The client's side of NatNet without its sockets: what the datagrams of one server mean. A recording is read by it, too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/io/mocap/natnet.hpp"
#include "swiftlet/services/mocap/sources/server_clock.hpp"

namespace swiftlet::mocap {

class NatNetSession {
 public:
  enum class Event {
    kNothing,  // of no interest, or too early
    kServer,   // server() is set, or has changed
    kModels,   // models() is set, or has changed
    kFrame,    // frame() is newer than the last
    kLate,     // a frame that is not newer than the last
    kEcho,     // clock() is better known
    kRefused,  // refusal() says why
  };

  // arrived_ns: clock of this host.
  Event take(const std::uint8_t* data, std::size_t size, std::int64_t arrived_ns);

  const std::optional<natnet::ServerInfo>& server() const { return server_; }
  const std::vector<natnet::BodyDefinition>& models() const { return models_; }
  const natnet::Frame& frame() const { return frame_; }
  std::uint64_t lost() const { return lost_; }  // frames between those that arrived
  const ServerClock& clock() const { return clock_; }
  const std::string& refusal() const { return refusal_; }

  // The definitions are unknown, or not those of the frames.
  bool needs_models() const { return needs_models_; }

  // When the frame was exposed, by the clock of this host. With `by_arrival`, if the server's clock is unknown: its arrival minus
  // the latency that the server states. nullopt if that is unknown, too.
  std::optional<std::int64_t> exposed_ns(std::int64_t arrived_ns, bool by_arrival) const;
  // From the exposure to the transmission, by the server's clock; 0: not told.
  std::int64_t server_latency_ns() const;

  // The server has been silent: it may begin anew with any number, model or clock.
  void forget_order();

 private:
  Event take_server(const io::ByteReader& payload);
  Event take_models(const io::ByteReader& payload);
  Event take_frame(const io::ByteReader& payload);
  Event take_echo(const io::ByteReader& payload, std::int64_t arrived_ns);
  Event refuse(const char* why);
  bool can_read() const;
  bool follows(std::int32_t number);
  bool knows_all_bodies() const;
  std::int64_t ns(std::uint64_t ticks) const;

  std::optional<natnet::ServerInfo> server_;
  std::vector<natnet::BodyDefinition> models_;
  natnet::Frame frame_;
  natnet::Frame incoming_;
  std::optional<std::int32_t> last_number_;
  std::uint64_t lost_ = 0;
  bool needs_models_ = true;
  ServerClock clock_;
  std::string refusal_;
};

// "Motive 2.1 (NatNet 3.0)".
std::string to_string(const natnet::ServerInfo& server);

}  // namespace swiftlet::mocap
