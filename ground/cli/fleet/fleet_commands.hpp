// The subcommands of `swiftlet fleet`.
#pragma once

#include "swiftlet/ground/command_line/command.hpp"

namespace swiftlet::ground {

Command add_fleet_check_command(runtime::CommandLine fleet);

}  // namespace swiftlet::ground
