#include <cstdio>
#include <vector>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/command_line/installation.hpp"
#include "swiftlet/ground/mission/mission_plot.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"

namespace swiftlet::ground {
namespace {

struct Options {
  std::string file;
  std::string control = "motor_lag";
  std::string output = "mission.png";
  std::vector<double> start = {0.0, 0.0};
};

int run(const Options& options) {
  const auto settings = runtime::load_control_settings(configuration_file("control", options.control));
  const MissionFile file = load_mission_file(configuration_file("missions", options.file), settings.limits);
  const MissionDryRun dry_run = dry_run(file.mission, settings, {options.start[0], options.start[1]});
  if (!dry_run.completed)
    std::fprintf(stderr, "swiftlet: mission %s: %s\n", file.name.c_str(), dry_run.reason.c_str());
  if (dry_run.legs.empty()) return kFailed;
  const std::string fault = draw_mission(options.output, file, dry_run, settings.limits);
  if (!fault.empty()) {
    std::fprintf(stderr, "swiftlet: %s\n", fault.c_str());
    return kFailed;
  }
  std::printf("%s: %s shows %.1f s of flight\n", file.name.c_str(), options.output.c_str(),
              dry_run.duration_s);
  return dry_run.completed ? kDone : kFailed;
}

}  // namespace

Command add_mission_plot_command(runtime::CommandLine mission) {
  const auto options = std::make_shared<Options>();
  const runtime::CommandLine app =
      mission.add_subcommand("plot", "Draw the path of a mission file, with its limits and its fence");
  app.footer("example: swiftlet mission plot square -o square.png");
  app.add_option("file", options->file,
                 "mission file, or the name of one in the configuration; also files of others")
      .required();
  app.add_option("-o,--out", options->output, "the picture, PNG").show_default();
  app.add_option("--control", options->control,
                 "control settings whose limits and fence hold, a file or a name")
      .show_default();
  app.add_option("--start", options->start, "where the vehicle stands: north and east, m").expected(2);
  return {app, [options] { return run(*options); }};
}

}  // namespace swiftlet::ground
