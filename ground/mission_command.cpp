#include <vector>

#include "swiftlet/ground/client.hpp"
#include "swiftlet/ground/commands.hpp"

namespace swiftlet::ground {

Command add_mission_command(runtime::CommandLine root) {
  const runtime::CommandLine mission =
      root.add_subcommand("mission", "Check a mission file, draw it, and fly it with a running vehicle");
  mission.require_subcommand(1, 1);
  mission.footer("example: swiftlet mission check square && swiftlet mission fly square");
  const std::vector<Command> commands = {
      add_mission_check_command(mission),  add_mission_plot_command(mission),
      add_mission_fly_command(mission),    add_mission_upload_command(mission),
      add_mission_start_command(mission),  add_mission_pause_command(mission),
      add_mission_resume_command(mission), add_mission_skip_command(mission),
      add_mission_clear_command(mission),
  };
  return {mission, [commands] {
            for (const Command& command : commands) {
              if (command.app.parsed()) return command.run();
            }
            return kBadInput;
          }};
}

}  // namespace swiftlet::ground
