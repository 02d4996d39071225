// The network options that all commands which talk to a vehicle have in common.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::ground {

// How many vehicles a command accepts. NodeSettings::vehicle holds several names as one list, see
// messages::vehicles_of_list().
enum class Vehicles { kOne, kSeveral };

// Adds the options of dds::add_node_options() and refuses invalid vehicle names as bad input. `network`
// must outlive the parsing.
void add_network_options(runtime::CommandLine app, dds::NodeSettings& network,
                         Vehicles vehicles = Vehicles::kOne);

// The options of a process of this host with these settings, without the name of the vehicle.
std::vector<std::string> network_arguments(const dds::NodeSettings& network);

}  // namespace swiftlet::ground
