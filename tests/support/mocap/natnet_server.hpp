// A NatNet server for tests, on the loopback interface, in a thread of its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "swiftlet/io/network/sockets.hpp"
#include "tests/support/mocap/natnet_packets.hpp"

namespace swiftlet::tests {

// Answers connect, discovery, definition and echo requests. Frames go to who has connected, by unicast, or to the group.
class NatNetServer {
 public:
  static constexpr std::int64_t kLatencyNs = 100'000;

  struct Settings {
    std::string address = "127.0.0.1";
    natnet::Server server;
    std::int64_t clock_offset_ns = 0;  // of its clock against the monotonic clock of this host
    bool answers_echo = true;
    std::uint16_t port = 0;  // 0: one that is free
  };

  explicit NatNetServer(Settings settings);
  ~NatNetServer();
  NatNetServer(const NatNetServer&) = delete;
  NatNetServer& operator=(const NatNetServer&) = delete;

  std::uint16_t port() const { return commands_.port(); }
  std::string name() const { return settings_.address + ":" + std::to_string(port()); }

  // The models that requests are answered with.
  void set_models(std::vector<natnet::Body> models);
  // Sends a frame that was exposed latency_ns ago; 0: as one without a stamp of the exposure. false: nobody is connected.
  bool send(natnet::Frame frame, std::int64_t latency_ns = kLatencyNs);
  // The clock jumps to this offset against the monotonic clock of this host.
  void set_clock(std::int64_t offset_ns) { clock_offset_ns_ = offset_ns; }
  bool is_connected() const;
  std::uint64_t echoes() const { return echoes_; }
  std::uint64_t keep_alives() const { return keep_alives_; }
  std::uint64_t ticks(std::int64_t monotonic_ns) const;

 private:
  void run();
  void answer(const std::vector<std::uint8_t>& datagram, const io::Endpoint& from);

  const Settings settings_;
  std::atomic<std::int64_t> clock_offset_ns_;
  io::UdpSocket commands_;
  mutable std::mutex mutex_;  // guards the two below
  std::vector<natnet::Body> models_;
  std::optional<io::Endpoint> client_;
  std::atomic<std::uint64_t> echoes_{0};
  std::atomic<std::uint64_t> keep_alives_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace swiftlet::tests
