#include <cstdio>

#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/ground/cli/request_command.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/format.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"

namespace swiftlet::ground {
namespace {

struct Options : CommandOptions {
  std::string file;
  FileOptions reading;
  std::string control = "motor_lag";
};

int upload(const Options& options) {
  const auto settings =
      runtime::load_control_settings(runtime::configuration_file(runtime::kinds::kControl, options.control));
  const MissionFile file = load_mission_file(
      runtime::configuration_file(runtime::kinds::kMission, options.file), settings.limits, options.reading);
  for (const std::string& assumption : file.assumptions)
    std::fprintf(stderr, "%s: %s\n", file.name.c_str(), assumption.c_str());
  Vehicle vehicle(options.network);
  const Result answer = vehicle.upload(file.mission, options.timeout()).answer();
  if (options.json) {
    nlohmann::ordered_json json = {{"mission", file.name}, {"accepted", answer.accepted()}};
    if (answer.accepted()) json["mission_id"] = vehicle.uploaded_id();
    if (!answer.accepted()) json["reason"] = answer.reason;
    std::printf("%s\n", json.dump().c_str());
  } else if (answer.accepted()) {
    std::printf("%s: uploaded to %s as mission %llu, %s\n", file.name.c_str(),
                options.network.vehicle.c_str(), static_cast<unsigned long long>(vehicle.uploaded_id()),
                counted(file.mission.items.size(), "item").c_str());
  }
  if (!answer.accepted())
    std::fprintf(stderr, "swiftlet: mission %s: %s\n", file.name.c_str(), answer.reason.c_str());
  return answer.accepted() ? kDone : kFailed;
}

}  // namespace

Command add_mission_upload_command(runtime::CommandLine mission) {
  const auto options = std::make_shared<Options>();
  const runtime::CommandLine app = add_vehicle_subcommand(
      mission, "upload", "Upload a mission to the vehicle, to be started with `mission start`",
      "swiftlet mission upload square && swiftlet mission start", options);
  app.add_option("file", options->file,
                 "mission file, or the name of one in config/missions; also CSV or QGroundControl .plan")
      .type_name(runtime::kinds::kMission.value)
      .required();
  add_file_options(app, options->reading);
  app.add_option("--control", options->control,
                 "control settings with the limits and the fence for the mission check")
      .type_name(runtime::kinds::kControl.value)
      .show_default();
  return {app, [options] { return upload(*options); }};
}

}  // namespace swiftlet::ground
