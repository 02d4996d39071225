// swiftlet: the ground tool. Holds what a flight needs; other programs carry out the commands of program_commands().
#include <vector>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/services/runtime/version.hpp"

int main(int argc, char** argv) {
  using namespace swiftlet;
  if (const io::ProgramCommand* const command = io::program_command_of(argc, argv))
    return io::execute_program(*command, argv);
  return io::run_commands(argc, argv, runtime::version_text(), [](runtime::CommandLine root) {
    std::vector<io::Command> commands = {
        ground::add_fly_command(root, runtime::version_text()),
        ground::add_arm_command(root),
        ground::add_disarm_command(root),
        ground::add_takeoff_command(root),
        ground::add_goto_command(root),
        ground::add_land_command(root),
        ground::add_hold_command(root),
        ground::add_stop_command(root),
        ground::add_mission_command(root),
        ground::add_trajectory_command(root),
        ground::add_stream_command(root),
        ground::add_status_command(root),
        ground::add_watch_command(root),
        ground::add_list_command(root),
        ground::add_record_command(root, runtime::version_text()),
        ground::add_set_command(root),
        ground::add_sim_command(root, runtime::version_text()),
        ground::add_config_command(root),
        ground::add_completion_command(root),
        ground::add_manual_command(root),
    };
    io::add_program_commands(root);
    return commands;
  });
}
