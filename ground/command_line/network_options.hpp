// Where a vehicle is to be found: the options that all commands which talk to one share.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::ground {

// Whom a command asks. The names of several stand in NodeSettings::vehicle as one list: split_list().
enum class Vehicles { kOne, kSeveral };

// The options of comms::add_node_options, a name that cannot be one refused as bad input. `network` must
// outlive the parsing.
void add_network_options(runtime::CommandLine app, comms::NodeSettings& network,
                         Vehicles vehicles = Vehicles::kOne);

// What stands between the commas.
std::vector<std::string> split_list(const std::string& list);

std::string to_string(comms::Transport transport);  // as on the command line

}  // namespace swiftlet::ground
