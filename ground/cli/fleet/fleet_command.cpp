// `swiftlet fleet`: flights of several vehicles from one file.
#include <vector>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/fleet/fleet_commands.hpp"
#include "swiftlet/io/command_line/programs.hpp"

namespace swiftlet::ground {

io::Command add_fleet_command(runtime::CommandLine root, const std::string& version) {
  const runtime::CommandLine fleet = root.add_subcommand("fleet", io::purpose_of("fleet"));
  fleet.require_subcommand(1, 1);
  fleet.footer("example: swiftlet fleet check swap6 && swiftlet fleet fly swap6");
  const std::vector<io::Command> commands = {
      add_fleet_check_command(fleet), add_fleet_plot_command(fleet), add_fleet_fly_command(fleet, version),
      add_fleet_goto_command(fleet),  add_fleet_land_command(fleet), add_fleet_stop_command(fleet)};
  return {fleet, [commands] { return io::run_given(commands); }};
}

}  // namespace swiftlet::ground
