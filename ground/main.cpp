// swiftlet: the ground tool.
#include <cstdio>
#include <exception>
#include <vector>

#include <CLI/CLI.hpp>

#include "ground/commands.hpp"
#include "services/runtime/config_error.hpp"

namespace {

using namespace swiftlet;

int complain(const std::exception& error, int code) {
  std::fprintf(stderr, "swiftlet: %s\n", error.what());
  return code;
}

int run_chosen(const CLI::App& app, const std::vector<ground::Command>& commands) {
  for (const ground::Command& command : commands) {
    if (command.app->parsed()) return command.run();
  }
  std::fprintf(stderr, "%s\nswiftlet: a command is required\n", app.help().c_str());
  return ground::kBadInput;
}

int run(int argc, char** argv) {
  CLI::App app("Swiftlet: fly micro quadrotors over DDS", "swiftlet");
  app.require_subcommand(0, 1);
  app.footer(
      "example: swiftlet fly square\n`swiftlet COMMAND --help` explains a command.\nExit codes: 0 done, 1 "
      "failed, 2 bad input.");
  const std::vector<ground::Command> commands = {
      ground::add_fly_command(app),        ground::add_arm_command(app),    ground::add_disarm_command(app),
      ground::add_takeoff_command(app),    ground::add_goto_command(app),   ground::add_land_command(app),
      ground::add_hold_command(app),       ground::add_stop_command(app),   ground::add_mission_command(app),
      ground::add_trajectory_command(app), ground::add_stream_command(app), ground::add_status_command(app),
      ground::add_watch_command(app),      ground::add_list_command(app),   ground::add_report_command(app),
      ground::add_gains_command(app),      ground::add_sim_command(app),    ground::add_identify_command(app),
      ground::add_completion_command(app), ground::add_manual_command(app),
  };
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return ground::kBadInput;
  }
  return run_chosen(app, commands);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const ground::InputError& error) {
    return complain(error, ground::kBadInput);
  } catch (const runtime::ConfigError& error) {
    return complain(error, ground::kBadInput);
  } catch (const std::exception& error) {
    return complain(error, ground::kFailed);
  }
}
