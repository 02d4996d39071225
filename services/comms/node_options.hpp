// The command-line options of every program that joins the network.
#pragma once

#include "services/comms/node.hpp"

namespace CLI {
class App;
}

namespace swiftlet::comms {

// --domain (default $ROS_DOMAIN_ID or 0), --vehicle-name, --transport udp|shm, --localhost-only.
void add_node_options(CLI::App& app, NodeSettings& settings);

}  // namespace swiftlet::comms
