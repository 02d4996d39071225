// Where a vehicle is to be found: the options that all commands which talk to one share.
#pragma once

#include "services/comms/node.hpp"

namespace CLI {
class App;
}

namespace swiftlet::ground {

// Adds --vehicle-name, --transport and --localhost-only; `network` must outlive the parsing.
void add_vehicle_options(CLI::App& app, comms::NodeSettings& network);

// Adds --domain, which $SWIFTLET_DOMAIN sets too.
void add_domain_option(CLI::App& app, int& domain);

constexpr int kMaxDomain = 232;

const char* to_string(comms::Transport transport);  // as on the command line

}  // namespace swiftlet::ground
