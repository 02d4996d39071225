#include "swiftlet/services/dds/discovery/peer_log.hpp"

#include <spdlog/spdlog.h>

namespace swiftlet::comms {

void log_peers(Node& node) {
  node.on_peer([](const PeerEvent& event) {
    if (event.alive) {
      spdlog::info("{} joined", event.name);
    } else if (event.said_goodbye) {
      spdlog::info("{} left", event.name);
    } else {
      spdlog::warn("{} died or was cut off", event.name);
    }
  });
}

}  // namespace swiftlet::comms
