// `swiftlet mission start`, `pause`, `resume`, `skip` and `clear`: of the mission that the vehicle has.
#include <CLI/CLI.hpp>

#include "ground/commands.hpp"
#include "ground/request_command.hpp"

namespace swiftlet::ground {
namespace {

struct Options : RequestOptions {
  std::uint64_t id = 0;
};

Command add_mission_request(CLI::App& mission, const std::string& name, const std::string& description,
                            std::uint8_t kind) {
  const auto options = std::make_shared<Options>();
  CLI::App* const app =
      add_request_subcommand(mission, name, description, "swiftlet mission " + name, options);
  app->add_option("--id", options->id,
                  "refuse if the mission there is another one: the number that `mission upload` said");
  return {app, [options, name, kind] {
            return run_request(*options, "mission " + name, [&](Client& client) {
              return client.mission_command(kind, options->id, milliseconds(options->timeout_s));
            });
          }};
}

}  // namespace

Command add_mission_start_command(CLI::App& mission) {
  return add_mission_request(mission, "start",
                             "Fly the mission that was uploaded, from its first item; again, if it has ended",
                             msg::Command_Constants::MISSION_START);
}

Command add_mission_pause_command(CLI::App& mission) {
  return add_mission_request(mission, "pause", "Come to rest on the path and hold, to be gone on with",
                             msg::Command_Constants::MISSION_PAUSE);
}

Command add_mission_resume_command(CLI::App& mission) {
  return add_mission_request(mission, "resume", "Back to where the mission was left, and on",
                             msg::Command_Constants::MISSION_RESUME);
}

Command add_mission_skip_command(CLI::App& mission) {
  return add_mission_request(mission, "skip", "Give up the item that is flown or paused, on with the next",
                             msg::Command_Constants::MISSION_SKIP);
}

Command add_mission_clear_command(CLI::App& mission) {
  return add_mission_request(mission, "clear", "Forget the mission; refused while it is flown",
                             msg::Command_Constants::MISSION_CLEAR);
}

}  // namespace swiftlet::ground
