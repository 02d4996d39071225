#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/ground/mission/mission_page.hpp"
#include "swiftlet/ground/mission/mission_plot.hpp"
#include "swiftlet/ground/mission/pace.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"

namespace swiftlet::ground {
namespace {

struct MissionPlotOptions {
  std::string file;
  ReadingOptions reading;
  std::string vehicle = "kaylion";
  std::string control = "motor_lag";
  std::string output = "mission.png";
  std::vector<double> start = {0.0, 0.0};
};

int plot_missions(const MissionPlotOptions& options) {
  const auto settings =
      io::load_control_settings(io::configuration_file(io::kinds::kControl, options.control));
  const plant::Vehicle vehicle =
      io::load_vehicle(io::configuration_file(io::kinds::kVehicle, options.vehicle));
  const io::MissionFile file = load_mission(io::configuration_file(io::kinds::kMission, options.file),
                                            options.reading, vehicle, settings);
  const MissionDryRun flown = dry_run(file.mission, settings, {options.start[0], options.start[1]});
  if (!flown.completed)
    std::fprintf(stderr, "swiftlet: mission %s: %s\n", file.name.c_str(), flown.reason.c_str());
  if (flown.legs.empty()) return io::kFailed;
  const bool page = std::filesystem::path(options.output).extension() == ".html";
  std::string fault;
  if (page) {
    io::write_atomically(options.output, mission_page(file, flown, settings.limits));
  } else {
    fault = draw_mission(options.output, file, flown, settings.limits);
  }
  if (!fault.empty()) {
    std::fprintf(stderr, "swiftlet: %s\n", fault.c_str());
    return io::kFailed;
  }
  std::printf("%s: wrote %s, %.1f s of flight\n", file.name.c_str(), options.output.c_str(),
              flown.duration_s);
  return flown.completed ? io::kDone : io::kFailed;
}

}  // namespace

io::Command add_mission_plot_command(runtime::CommandLine mission) {
  const auto options = std::make_shared<MissionPlotOptions>();
  const runtime::CommandLine app = mission.add_subcommand("plot", io::purpose_of("mission plot"));
  app.footer(
      "example: swiftlet mission plot square -o square.png\n"
      "example: swiftlet mission plot square -o square.html");
  app.add_option("file", options->file,
                 "mission file, or the name of one in config/missions; also CSV or QGroundControl .plan")
      .type_name(io::kinds::kMission.value)
      .required();
  add_file_options(app, options->reading);
  app.add_option("--vehicle", options->vehicle,
                 "vehicle of --as-fast-as-possible: a file, or the name of one in config/vehicles")
      .type_name(io::kinds::kVehicle.value)
      .show_default();
  app.add_option("-o,--out", options->output,
                 "output file: FILE.html is a page with the path in space, any other name a PNG picture")
      .show_default();
  app.add_option("--control", options->control,
                 "control settings file, or the name of one in config/control: its limits and fence apply")
      .type_name(io::kinds::kControl.value)
      .show_default();
  app.add_option("--start", options->start, "start position of the vehicle: north and east, m")
      .finite()
      .expected(2);
  return {app, [options] { return plot_missions(*options); }};
}

}  // namespace swiftlet::ground
