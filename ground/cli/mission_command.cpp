// `swiftlet mission`, and its subcommands that control the mission on the vehicle: `start`, `pause`,
// `resume`, `skip` and `clear`.
#include <vector>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/request_command.hpp"

namespace swiftlet::ground {
namespace {

struct MissionOptions : RequestOptions {
  std::uint64_t id = 0;
};

using Ask = ActionHandle (Vehicle::*)(std::uint64_t, std::chrono::milliseconds);

io::Command add_mission_request(runtime::CommandLine mission, const std::string& name,
                                const std::string& description, Ask ask,
                                OnInterrupt on_interrupt = OnInterrupt::kPauseMission,
                                bool done_when_accepted = false) {
  const auto options = std::make_shared<MissionOptions>();
  const runtime::CommandLine app =
      add_request_subcommand(mission, name, description, "swiftlet mission " + name, options);
  app.add_option("--id", options->id,
                 "mission id that `mission upload` printed; refused if the vehicle has another mission")
      .whole();
  return {app, [=] {
            return run_request(
                *options, {"mission " + name,
                           [&](Vehicle& vehicle) { return (vehicle.*ask)(options->id, options->timeout()); },
                           on_interrupt, done_when_accepted});
          }};
}

}  // namespace

io::Command add_mission_start_command(runtime::CommandLine mission) {
  return add_mission_request(mission, "start",
                             "Start the uploaded mission at its first item; Ctrl-C pauses it",
                             &Vehicle::start_mission);
}

io::Command add_mission_pause_command(runtime::CommandLine mission) {
  return add_mission_request(mission, "pause", "Come to rest on the path and hold; `resume` continues",
                             &Vehicle::pause_mission, OnInterrupt::kNothing);
}

io::Command add_mission_resume_command(runtime::CommandLine mission) {
  return add_mission_request(mission, "resume", "Return to where the mission was paused, and continue",
                             &Vehicle::resume_mission);
}

io::Command add_mission_skip_command(runtime::CommandLine mission) {
  return add_mission_request(mission, "skip", "Skip the current item, flown or paused, and fly the next one",
                             &Vehicle::skip_mission_item);
}

io::Command add_mission_clear_command(runtime::CommandLine mission) {
  return add_mission_request(mission, "clear", "Delete the uploaded mission; refused while it is flown",
                             &Vehicle::clear_mission, OnInterrupt::kNothing, true);
}

io::Command add_mission_command(runtime::CommandLine root) {
  const runtime::CommandLine mission = root.add_subcommand("mission", kMissionPurpose);
  mission.require_subcommand(1, 1);
  mission.footer("example: swiftlet mission upload square && swiftlet mission start");
  const std::vector<io::Command> commands = {
      add_mission_check_command(mission),  add_mission_upload_command(mission),
      add_mission_start_command(mission),  add_mission_pause_command(mission),
      add_mission_resume_command(mission), add_mission_skip_command(mission),
      add_mission_clear_command(mission),
  };
  return {mission, [commands] { return io::run_given(commands); }};
}

}  // namespace swiftlet::ground
