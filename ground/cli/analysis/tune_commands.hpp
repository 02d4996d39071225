// The subcommands of `swiftlet tune`.
#pragma once

#include "swiftlet/io/command_line/command.hpp"

namespace swiftlet::ground {

io::Command add_tune_delay_command(runtime::CommandLine tune);
io::Command add_tune_plot_command(runtime::CommandLine tune);

}  // namespace swiftlet::ground
