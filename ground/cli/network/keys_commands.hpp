// The subcommands of `swiftlet keys`.
#pragma once

#include "swiftlet/io/command_line/command.hpp"

namespace swiftlet::ground {

Command add_keys_create_command(runtime::CommandLine keys);
Command add_keys_network_command(runtime::CommandLine keys);
Command add_keys_renew_command(runtime::CommandLine keys);
Command add_keys_revoke_command(runtime::CommandLine keys);

}  // namespace swiftlet::ground
