#include <cstdio>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "ground/client.hpp"
#include "ground/commands.hpp"
#include "ground/installation.hpp"
#include "ground/interrupts.hpp"
#include "ground/mission_file.hpp"
#include "ground/progress_line.hpp"
#include "ground/request_command.hpp"
#include "services/runtime/control_settings_file.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;

constexpr auto kStep = 50ms;
constexpr double kSilenceS = 3.0;

struct Options : RequestOptions {
  std::string file;
  std::string control = "motor_lag";
  bool no_wait = false;
  bool link = false;
};

// How a mission ended, as far as it was followed.
struct End {
  bool completed = false;
  std::string reason;
};

void show(const View& view, const MissionFile& mission, ProgressLine& progress) {
  const auto& status = view.mission.message;
  const auto& position = view.estimate.message.position_ned();
  char text[160];
  std::snprintf(text, sizeof text, "%u/%zu  %s  (%5.2f, %5.2f, %5.2f) m, %.2f V", status.item_index() + 1,
                mission.mission.items.size(), mode_name(view.control.message.mode()), position[0],
                position[1], position[2], view.battery.message.voltage_v());
  progress.update(static_cast<int>(status.item_index()), text);
}

End follow(Client& client, const MissionFile& mission) {
  const Interrupts interrupts;
  ProgressLine progress;
  const std::uint64_t id = client.mission_id();
  const auto ended = [id](const View& view) {
    const auto state = view.mission.message.state();
    return view.mission.message.mission_id() == id && (state == msg::MissionStatus_Constants::COMPLETED ||
                                                       state == msg::MissionStatus_Constants::ABORTED);
  };
  while (!client.wait(kStep, ended)) {
    const View view = client.view();
    show(view, mission, progress);
    if (interrupts.count() > 0) return {false, "no longer followed; the vehicle flies on"};
    if (view.control.age_s(Clock::now()) > kSilenceS) return {false, "control has said nothing for 3 s"};
  }
  const View view = client.view();
  if (view.mission.message.state() == msg::MissionStatus_Constants::COMPLETED) return {true, ""};
  return {false, "aborted: " + std::string(view.mission.message.reason().c_str())};
}

int fly_mission(const Options& options) {
  const auto settings = runtime::load_control_settings(configuration_file("control", options.control));
  const MissionFile mission =
      load_mission_file(configuration_file("missions", options.file), settings.limits);
  for (const std::string& assumption : mission.assumptions)
    std::fprintf(stderr, "%s: %s\n", mission.name.c_str(), assumption.c_str());
  Client client(options.network);
  if (options.link) client.stay();
  Answer answer = client.upload(mission.mission, options.timeout());
  if (answer.accepted()) {
    answer =
        client.mission_command(msg::Command_Constants::MISSION_START, client.mission_id(), options.timeout());
  }
  End end = {answer.accepted(), answer.reason};
  if (answer.accepted() && !options.no_wait) end = follow(client, mission);

  if (options.json) {
    nlohmann::ordered_json json = {{"mission", mission.name}, {"accepted", answer.accepted()}};
    if (!options.no_wait) json["completed"] = end.completed;
    if (!end.completed) json["reason"] = end.reason;
    std::printf("%s\n", json.dump().c_str());
  } else if (end.completed) {
    std::printf("%s: %s\n", mission.name.c_str(), options.no_wait ? "started" : "completed");
  }
  if (!end.completed)
    std::fprintf(stderr, "swiftlet: mission %s: %s\n", mission.name.c_str(), end.reason.c_str());
  return end.completed ? kDone : kFailed;
}

}  // namespace

Command add_mission_fly_command(CLI::App& mission) {
  const auto options = std::make_shared<Options>();
  CLI::App* const app =
      add_request_subcommand(mission, "fly", "Upload a mission file, start it and follow it to its end",
                             "swiftlet mission fly config/missions/square.yaml", options);
  app->add_option(
         "file", options->file,
         "mission file, or the name of one in the configuration; also a trajectory or waypoints as CSV, "
         "or a QGroundControl .plan")
      ->required();
  app->add_option("--control", options->control,
                  "control settings whose limits and fence the file is checked against")
      ->capture_default_str();
  CLI::Option* const no_wait =
      app->add_flag("--no-wait", options->no_wait, "return once it has been started");
  app->add_flag(
         "--link", options->link,
         "the flight depends on this command: if it falls silent, the vehicle does what ground_link_action "
         "of its control settings says")
      ->excludes(no_wait);
  return {app, [options] { return fly_mission(*options); }};
}

}  // namespace swiftlet::ground
