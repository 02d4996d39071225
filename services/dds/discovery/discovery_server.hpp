// A discovery server: a process that tells the processes of a domain of each other, so that they need neither
// multicast nor each other's addresses. It carries no samples.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace swiftlet::comms {

struct DiscoveryServerSettings {
  int number = 0;  // 0 .. 255: its place in the list of --discovery-server
  int domain = 0;
  int port = 0;
  std::vector<std::string> interfaces{};  // as in NetworkSettings
  std::string network_key_file{};         // as in NodeSettings
};

// A process registered at the server, or is gone.
struct DiscoveryServerEvent {
  std::string process;  // "plant (process 4711 on host lab1)", or a name for programs of others
  bool alive = false;
  bool said_goodbye = false;  // if not alive: it ended cleanly; else it died or was cut off
};

class DiscoveryServer {
 public:
  // Takes 0.25 s until it serves. on_event runs in a middleware thread. Throws std::runtime_error if the port cannot be opened, or
  // the key file is not valid.
  DiscoveryServer(const DiscoveryServerSettings& settings,
                  std::function<void(const DiscoveryServerEvent&)> on_event);
  ~DiscoveryServer();
  DiscoveryServer(const DiscoveryServer&) = delete;
  DiscoveryServer& operator=(const DiscoveryServer&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace swiftlet::comms
