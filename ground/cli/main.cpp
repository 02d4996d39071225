// swiftlet: the ground tool.
#include <cstdio>
#include <vector>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/command_line/run_command_line.hpp"
#include "swiftlet/services/runtime/version.hpp"

int main(int argc, char** argv) {
  using namespace swiftlet;
  runtime::Program program("swiftlet", "Swiftlet: fly micro quadrotors over DDS");
  program.add_version(runtime::version_text());
  const runtime::CommandLine root = program.command_line();
  root.require_subcommand(0, 1);
  root.footer(
      "example: swiftlet fly square\n`swiftlet COMMAND --help` explains a command.\nExit codes: 0 success, 1 "
      "failed or refused, 2 bad input.");
  const std::vector<ground::Command> commands = {
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
      ground::add_fleet_command(root, runtime::version_text()),
      ground::add_stream_command(root),
      ground::add_teleop_command(root),
      ground::add_status_command(root),
      ground::add_watch_command(root),
      ground::add_list_command(root),
      ground::add_view_command(root, runtime::version_text()),
      ground::add_mocap_command(root),
      ground::add_discovery_server_command(root),
      ground::add_doctor_command(root),
      ground::add_check_command(root),
      ground::add_record_command(root, runtime::version_text()),
      ground::add_log_command(root),
      ground::add_report_command(root),
      ground::add_gains_command(root),
      ground::add_tune_command(root),
      ground::add_set_command(root),
      ground::add_sim_command(root, runtime::version_text()),
      ground::add_identify_command(root, argv),
      ground::add_config_command(root),
      ground::add_keys_command(root),
      ground::add_completion_command(root),
      ground::add_manual_command(root),
  };
  return ground::run_command_line(program, argc, argv, [&] {
    for (const ground::Command& command : commands) {
      if (command.app.parsed()) return command.run();
    }
    std::fprintf(stderr, "%s\nswiftlet: a command is required\n", root.help().c_str());
    return ground::kBadInput;
  });
}
