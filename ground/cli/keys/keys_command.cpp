// `swiftlet keys`: makes the keys that protect a network.
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/keys/keys_commands.hpp"

namespace swiftlet::ground {

Command add_keys_command(runtime::CommandLine root) {
  const runtime::CommandLine keys = root.add_subcommand("keys", "Make the keys that protect a network");
  keys.require_subcommand(1, 1);
  keys.footer("example: swiftlet keys network lab.key");
  const Command network = add_keys_network_command(keys);
  return {keys, network.run};
}

}  // namespace swiftlet::ground
