#include <cstdio>
#include <vector>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/command_line/installation.hpp"
#include "swiftlet/ground/mission/mission_check.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"

namespace swiftlet::ground {
namespace {

struct Options {
  std::string file;
  std::string vehicle = "kaylion";
  std::string control = "motor_lag";
  std::vector<double> start = {0.0, 0.0};
  double supply_voltage_v = 0.0;  // 0: the low-battery threshold
  bool json = false;
};

int run(const Options& options) {
  const plant::Vehicle vehicle = runtime::load_vehicle(configuration_file("vehicles", options.vehicle));
  const auto settings = runtime::load_control_settings(configuration_file("control", options.control));
  const MissionFile file = load_mission_file(configuration_file("missions", options.file), settings.limits);
  for (const std::string& assumption : file.assumptions)
    std::fprintf(stderr, "%s: %s\n", file.name.c_str(), assumption.c_str());
  const MissionDryRun dry_run = dry_run(file.mission, settings, {options.start[0], options.start[1]});
  const double supply_voltage_v =
      options.supply_voltage_v > 0.0 ? options.supply_voltage_v : settings.failsafe.low_battery_voltage;
  const MissionCheck check = check_mission(file, dry_run, vehicle, settings, supply_voltage_v);
  if (options.json) {
    std::printf("%s\n", check_json(check, file, vehicle.name, settings.name).c_str());
  } else {
    std::printf("%s", check_table(check, file, vehicle.name).c_str());
  }
  return check.feasible() ? kDone : kFailed;
}

}  // namespace

Command add_mission_check_command(runtime::CommandLine mission) {
  const auto options = std::make_shared<Options>();
  const runtime::CommandLine app = mission.add_subcommand(
      "check", "Whether a mission file is sound, and whether the vehicle can fly it everywhere on its path");
  app.footer(
      "example: swiftlet mission check square --vehicle kaylion\nExit codes: 0 it can be flown, 1 it cannot, "
      "2 "
      "the file is wrong.");
  app.add_option("file", options->file,
                 "mission file, or the name of one in the configuration; also files of others")
      .required();
  app.add_option("--vehicle", options->vehicle, "vehicle file, or the name of one in the configuration")
      .show_default();
  app.add_option("--control", options->control,
                 "control settings whose limits and fence hold, likewise a file or a name")
      .show_default();
  app.add_option("--start", options->start, "where the vehicle stands: north and east, m").expected(2);
  app.add_option("--supply", options->supply_voltage_v,
                 "battery voltage at which it must be possible, V; the low-battery threshold unless told")
      .range(0.1, 100.0);
  app.add_flag("--json", options->json, "print JSON");
  return {app, [options] { return run(*options); }};
}

}  // namespace swiftlet::ground
