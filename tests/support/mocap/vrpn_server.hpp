// A VRPN server for tests, on the loopback interface, in a thread of its own. One client at a time.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "swiftlet/io/mocap/vrpn.hpp"
#include "swiftlet/io/network/sockets.hpp"

namespace swiftlet::tests {

class VrpnServer {
 public:
  struct Settings {
    std::vector<std::string> trackers = {"kl1", "kl2"};
    std::int64_t clock_offset_ns = 0;  // of its clock against the system clock of this host
    bool by_udp = true;                // poses; else by TCP
    bool answers_pings = true;
    std::string cookie = "vrpn: ver. 07.38  0     ";
    std::uint16_t port = 0;  // 0: one that is free
  };

  explicit VrpnServer(Settings settings);
  ~VrpnServer();
  VrpnServer(const VrpnServer&) = delete;
  VrpnServer& operator=(const VrpnServer&) = delete;

  std::string name() const { return "127.0.0.1:" + std::to_string(port_); }
  std::uint16_t port() const { return port_; }
  bool is_connected() const { return is_connected_; }
  std::uint64_t pings() const { return pings_; }
  // Sends the pose of a tracker, exposed age_ns ago: x, y, z, and a quaternion x, y, z, w. false: nobody is connected.
  bool send(std::size_t tracker, const double (&pose)[7], std::int64_t age_ns = 0, std::int32_t sensor = 0);
  // Closes the connection.
  void drop() { drop_ = true; }

 private:
  void run();
  void accept();
  void read();
  void answer(const mocap::vrpn::Message& message);
  void write(const mocap::vrpn::Bytes& bytes) const;

  const Settings settings_;
  io::Descriptor listener_, connection_;
  std::uint16_t port_ = 0;
  std::optional<io::UdpSocket> udp_;
  std::mutex mutex_;  // guards what both threads use
  std::vector<std::uint8_t> received_;
  std::map<std::int32_t, std::string> types_;  // of the client
  std::optional<io::Endpoint> udp_client_;
  std::uint32_t sequence_ = 0;
  std::atomic<std::uint64_t> pings_{0};
  std::atomic<bool> is_connected_{false}, drop_{false}, stop_{false};
  std::thread thread_;
};

}  // namespace swiftlet::tests
