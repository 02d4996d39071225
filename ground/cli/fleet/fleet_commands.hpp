// The subcommands of `swiftlet fleet`.
#pragma once

#include <string>

#include "swiftlet/io/command_line/command.hpp"

namespace swiftlet::ground {

io::Command add_fleet_check_command(runtime::CommandLine fleet);
io::Command add_fleet_plot_command(runtime::CommandLine fleet);
io::Command add_fleet_goto_command(runtime::CommandLine fleet);
io::Command add_fleet_land_command(runtime::CommandLine fleet);
io::Command add_fleet_stop_command(runtime::CommandLine fleet);
// version: of the program, for the record.
io::Command add_fleet_fly_command(runtime::CommandLine fleet, const std::string& version);

}  // namespace swiftlet::ground
