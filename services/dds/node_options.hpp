// The command-line options of every program that joins the network.
#pragma once

#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::comms {

// --domain (default $ROS_DOMAIN_ID or 0), --vehicle-name, --transport udp|shm, --localhost-only.
void add_node_options(runtime::CommandLine app, NodeSettings& settings);

}  // namespace swiftlet::comms
