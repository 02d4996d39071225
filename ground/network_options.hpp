// Where a vehicle is to be found: the options that all commands which talk to one share.
#pragma once

#include <string>

#include "services/comms/node.hpp"

namespace CLI {
class App;
}

namespace swiftlet::ground {

// The options of comms::add_node_options, a name that cannot be one refused as bad input. `network` must
// outlive the parsing.
void add_network_options(CLI::App& app, comms::NodeSettings& network);

std::string to_string(comms::Transport transport);  // as on the command line

}  // namespace swiftlet::ground
