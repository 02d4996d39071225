// Logs discovered and lost peers.
#pragma once

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

// Sets the node's on_peer() callback.
void log_peers(Node& node);

}  // namespace swiftlet::comms
