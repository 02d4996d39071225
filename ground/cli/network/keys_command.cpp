// `swiftlet keys`: makes the keys that protect a network.
#include <vector>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/network/keys_commands.hpp"
#include "swiftlet/io/command_line/programs.hpp"

namespace swiftlet::ground {

io::Command add_keys_command(runtime::CommandLine root) {
  const runtime::CommandLine keys = root.add_subcommand("keys", io::purpose_of("keys"));
  keys.require_subcommand(1, 1);
  keys.footer("example: swiftlet keys network lab.key");
  const std::vector<io::Command> commands = {add_keys_network_command(keys), add_keys_create_command(keys),
                                             add_keys_renew_command(keys), add_keys_revoke_command(keys)};
  return {keys, [commands] { return io::run_given(commands); }};
}

}  // namespace swiftlet::ground
