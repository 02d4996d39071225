#include "swiftlet/services/dds/discovery/peer_log.hpp"

#include <string>

#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/log_label.hpp"

namespace swiftlet::comms {

void log_peers(Node& node) {
  node.on_peer([own = runtime::LogLabel::current()](const PeerEvent& event) {
    const runtime::LogLabel label(own);
    if (event.alive) {
      runtime::log_info("{} joined", event.name);
    } else if (event.said_goodbye) {
      runtime::log_info("{} left", event.name);
    } else {
      runtime::log_warning("{} died or was cut off", event.name);
    }
  });
}

}  // namespace swiftlet::comms
