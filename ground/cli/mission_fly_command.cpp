#include <cstdio>
#include <optional>

#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/request_command.hpp"
#include "swiftlet/ground/cli/sent_mission.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/io/json_text.hpp"

namespace swiftlet::ground {
namespace {

struct MissionFlyOptions : CommandOptions {
  SentFileOptions sent;
  bool no_wait = false;
  bool link = false;
};

int fly_mission(const MissionFlyOptions& options) {
  const SentFile sent(options.sent);
  const io::MissionFile mission = sent.mission();
  Vehicle vehicle(options.network);
  log_connection(vehicle, "mission " + mission.name);
  sent.require_flyable(vehicle, mission, options.timeout());
  if (options.link) vehicle.enable_link_loss_failsafe();
  const Interrupts interrupts;
  vehicle.cancel_when([&] { return interrupts.count() > 0; });
  const ActionHandle flight = vehicle.follow(mission.mission, options.timeout());
  ActionResult end = {ActionResult::Kind::kNotAccepted, flight.answer().reason};
  if (flight.answer().kind == Result::Kind::kCancelled) {
    end.reason =
        vehicle.connected() ? rest_after_interrupt(vehicle, OnInterrupt::kPauseMission) : "interrupted";
  } else if (flight.accepted() && options.no_wait) {
    end = {ActionResult::Kind::kCompleted, ""};
  } else if (flight.accepted()) {
    end = await_actions({{&vehicle, flight}}, mission.name, OnInterrupt::kPauseMission, interrupts,
                        std::nullopt)
              .front();
    if (end.kind == ActionResult::Kind::kCanceled) end.reason = interruption_by(end);
  }

  if (options.json) {
    nlohmann::ordered_json json = {{"mission", mission.name}, {"accepted", flight.accepted()}};
    if (!options.no_wait) json["completed"] = end.done();
    if (!end.done()) json["reason"] = end.reason;
    std::printf("%s\n", io::json_text(json).c_str());
  } else if (end.done()) {
    std::printf("%s: %s\n", mission.name.c_str(), options.no_wait ? "started" : "completed");
  }
  if (!end.done())
    std::fprintf(stderr, "swiftlet: mission %s: %s\n", mission.name.c_str(), end.reason.c_str());
  return end.done() ? io::kDone : io::kFailed;
}

}  // namespace

io::Command add_mission_fly_command(runtime::CommandLine mission) {
  const auto options = std::make_shared<MissionFlyOptions>();
  const runtime::CommandLine app = add_vehicle_subcommand(
      mission, "fly", "Upload a mission file, start it and wait until it ends; Ctrl-C pauses it",
      "swiftlet mission fly config/missions/square.yaml", options);
  add_sent_file_options(app, options->sent,
                        "mission file, or the name of one in config/missions; also a trajectory or waypoints "
                        "as CSV, or a QGroundControl .plan file");
  runtime::Option no_wait =
      app.add_flag("--no-wait", options->no_wait, "return when the mission has started");
  app.add_flag("--link", options->link,
               "enable the link-loss failsafe: if the heartbeat of this command stops, the vehicle executes "
               "ground_link_action of its control settings")
      .excludes(no_wait);
  return {app, [options] { return fly_mission(*options); }};
}

}  // namespace swiftlet::ground
