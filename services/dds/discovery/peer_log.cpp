#include "swiftlet/services/dds/discovery/peer_log.hpp"

#include <string>

#include <spdlog/spdlog.h>

#include "swiftlet/services/runtime/log_label.hpp"

namespace swiftlet::comms {

void log_peers(Node& node) {
  node.on_peer([own = runtime::LogLabel::current()](const PeerEvent& event) {
    const runtime::LogLabel label(own);
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
