// The network options that all commands which talk to a vehicle have in common.
#pragma once

#include <string>

#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::ground {

// How many vehicles a command accepts. NodeSettings::vehicle holds several names as one list, see
// comms::vehicles_of_list().
enum class Vehicles { kOne, kSeveral };

// Adds the options of comms::add_node_options() and refuses invalid vehicle names as bad input. `network`
// must outlive the parsing.
void add_network_options(runtime::CommandLine app, comms::NodeSettings& network,
                         Vehicles vehicles = Vehicles::kOne);

std::string to_string(comms::Transport transport);  // as on the command line

}  // namespace swiftlet::ground
