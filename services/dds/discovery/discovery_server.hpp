// A discovery server: a process that tells the processes of a domain of each other, so that they need neither
// multicast nor each other's addresses. It carries no samples.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "swiftlet/services/messages/qos.hpp"

namespace swiftlet::dds {

struct DiscoveryServerSettings {
  int number = 0;  // 0 .. 255: its place in the list of --discovery-server
  int domain = 0;
  int port = 0;
  std::vector<std::string> interfaces{};  // as in NetworkSettings
  std::string network_key_file{};         // as in NodeSettings
  bool open_network = false;              // as in NodeSettings

  bool on_loopback() const { return !open_network && network_key_file.empty(); }  // for this host only
};

// A process registered at the server, or is gone.
struct DiscoveryServerEvent {
  std::string process;  // "plant (process 4711 on host lab1)", or a name for programs of others
  bool alive = false;
  bool said_goodbye = false;  // if not alive: it ended cleanly; else it died or was cut off
};

class DiscoveryServer {
 public:
  // A server that was killed leaves clients that take the next one for it, and ignore what that numbers anew. They forget it
  // when its lease has ended, on a busy host later. Besides, Fast DDS 3.1 fails an assertion if it hears of a client before a
  // thread of it has taken in its own announcement.
  static constexpr auto kStartTime = 2 * messages::kLivelinessLease;

  // Hears nothing before serve(). on_event runs in a middleware thread. Throws std::runtime_error if the port cannot be opened,
  // or the key file is not valid; io::ConfigError for interfaces on_loopback().
  DiscoveryServer(const DiscoveryServerSettings& settings,
                  std::function<void(const DiscoveryServerEvent&)> on_event);
  ~DiscoveryServer();
  DiscoveryServer(const DiscoveryServer&) = delete;
  DiscoveryServer& operator=(const DiscoveryServer&) = delete;

  void serve();  // call it kStartTime after the construction

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace swiftlet::dds
