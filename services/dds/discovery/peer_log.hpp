// Peers that come and go, told in the process's log.
#pragma once

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

// Takes the node's on_peer().
void log_peers(Node& node);

}  // namespace swiftlet::comms
