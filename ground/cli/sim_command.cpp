#include "swiftlet/ground/cli/commands.hpp"

namespace swiftlet::ground {

io::Command add_sim_command(runtime::CommandLine root, const std::string& version) {
  const runtime::CommandLine sim = root.add_subcommand("sim", kSimPurpose);
  sim.require_subcommand(1, 1);
  const io::Command fly = add_sim_fly_command(sim, version);
  return {sim, fly.run};
}

}  // namespace swiftlet::ground
