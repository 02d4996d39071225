// The subcommands of `swiftlet keys`.
#pragma once

#include "swiftlet/io/command_line/command.hpp"

namespace swiftlet::ground {

io::Command add_keys_create_command(runtime::CommandLine keys);
io::Command add_keys_network_command(runtime::CommandLine keys);
io::Command add_keys_renew_command(runtime::CommandLine keys);
io::Command add_keys_revoke_command(runtime::CommandLine keys);

}  // namespace swiftlet::ground
