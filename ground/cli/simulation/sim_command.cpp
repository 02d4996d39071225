#include <vector>

#include "swiftlet/ground/cli/commands.hpp"

namespace swiftlet::ground {

Command add_sim_command(runtime::CommandLine root, const std::string& version) {
  const runtime::CommandLine sim = root.add_subcommand("sim", "Simulate without DDS, in one process");
  sim.require_subcommand(1, 1);
  const std::vector<Command> commands = {add_sim_fly_command(sim, version),
                                         add_sim_batch_command(sim, version), add_sim_merge_command(sim),
                                         add_sim_open_loop_command(sim)};
  return {sim, [commands] {
            for (const Command& command : commands) {
              if (command.app.parsed()) return command.run();
            }
            return kBadInput;
          }};
}

}  // namespace swiftlet::ground
