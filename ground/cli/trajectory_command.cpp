#include <cstdio>
#include <filesystem>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/ground/cli/request_command.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"

namespace swiftlet::ground {
namespace {

struct Options : RequestOptions {
  std::string file;
  FileOptions reading;
  std::string control = "motor_lag";
};

int send_trajectory(const Options& options) {
  const auto settings =
      runtime::load_control_settings(runtime::configuration_file(runtime::kinds::kControl, options.control));
  const std::string path = runtime::configuration_file(runtime::kinds::kMission, options.file);
  TrajectoryFile file = load_trajectory_file(path, settings.limits, options.reading);
  for (const std::string& assumption : file.assumptions)
    std::fprintf(stderr, "%s: %s\n", std::filesystem::path(path).stem().c_str(), assumption.c_str());
  const control::Trajectory trajectory{0, std::move(file.segments)};
  return run_request(options, {"trajectory", [&](Vehicle& vehicle) {
                                 return vehicle.follow(trajectory, options.timeout());
                               }});
}

}  // namespace

Command add_trajectory_command(runtime::CommandLine root) {
  const auto options = std::make_shared<Options>();
  const runtime::CommandLine app = add_request_subcommand(
      root, "trajectory", "Fly a trajectory of a CSV file; the vehicle joins it from its motion",
      "swiftlet trajectory config/missions/wave.csv", options, Vehicles::kOne);
  app.add_option("file", options->file,
                 "trajectory or waypoints as CSV, or the name of such in config/missions")
      .type_name(runtime::kinds::kMission.value)
      .required();
  add_file_options(app, options->reading);
  app.add_option("--control", options->control,
                 "control settings with the limits and the fence for the check of the file")
      .type_name(runtime::kinds::kControl.value)
      .show_default();
  return {app, [options] { return send_trajectory(*options); }};
}

}  // namespace swiftlet::ground
