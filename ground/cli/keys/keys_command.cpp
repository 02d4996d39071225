// `swiftlet keys`: makes the keys that protect a network.
#include <algorithm>
#include <array>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/keys/keys_commands.hpp"

namespace swiftlet::ground {

Command add_keys_command(runtime::CommandLine root) {
  const runtime::CommandLine keys = root.add_subcommand("keys", "Make the keys that protect a network");
  keys.require_subcommand(1, 1);
  keys.footer("example: swiftlet keys network lab.key");
  const std::array<Command, 4> commands = {add_keys_network_command(keys), add_keys_create_command(keys),
                                           add_keys_renew_command(keys), add_keys_revoke_command(keys)};
  return {keys, [commands] {
            const auto given = std::find_if(commands.begin(), commands.end(),
                                            [](const Command& c) { return c.app.parsed(); });
            return given->run();
          }};
}

}  // namespace swiftlet::ground
