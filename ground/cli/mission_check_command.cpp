#include <cstdio>
#include <optional>
#include <vector>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/ground/mission/mission_check.hpp"
#include "swiftlet/ground/mission/pace.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"

namespace swiftlet::ground {
namespace {

struct MissionCheckOptions {
  std::string file;
  ReadingOptions reading;
  std::string vehicle = "kaylion";
  std::string control = "motor_lag";
  std::vector<double> start = {0.0, 0.0};
  std::optional<double> supply_voltage_v;
  double state_of_charge = 1.0;
  bool json = false;
};

int check_missions(const MissionCheckOptions& options) {
  const plant::Vehicle vehicle =
      io::load_vehicle(io::configuration_file(io::kinds::kVehicle, options.vehicle));
  const auto settings =
      io::load_control_settings(io::configuration_file(io::kinds::kControl, options.control));
  const std::string path = io::configuration_file(io::kinds::kMission, options.file);
  const io::MissionFile file = load_mission(path, options.reading, vehicle, settings);
  for (const std::string& assumption : file.assumptions)
    std::fprintf(stderr, "%s: %s\n", file.name.c_str(), assumption.c_str());
  const CheckConditions conditions{
      {options.start[0], options.start[1]}, options.supply_voltage_v, 0.0, options.state_of_charge};
  const MissionCheck check = check_mission(file, vehicle, settings, conditions);
  const std::string help =
      check.feasible() ? "" : advice(file, path, options.reading, vehicle, settings, conditions);
  if (options.json) {
    std::printf("%s\n", check_json(check, file, vehicle.name, settings.name, help).c_str());
  } else {
    std::printf("%s", check_table(check, file, vehicle.name).c_str());
    if (!help.empty()) std::printf("it could be flown %s\n", help.c_str());
  }
  return check.feasible() ? io::kDone : io::kFailed;
}

}  // namespace

io::Command add_mission_check_command(runtime::CommandLine mission) {
  const auto options = std::make_shared<MissionCheckOptions>();
  const runtime::CommandLine app = mission.add_subcommand(
      "check", "Check a mission file, and whether the vehicle can fly every part of its path");
  app.footer(
      "example: swiftlet mission check square --vehicle kaylion\nExit codes: 0 the vehicle can fly it, 1 it "
      "cannot, 2 the file is invalid.");
  app.add_option("file", options->file,
                 "mission file, or the name of one in config/missions; also CSV or QGroundControl .plan")
      .type_name(io::kinds::kMission.value)
      .required();
  add_file_options(app, options->reading);
  app.add_option("--vehicle", options->vehicle, "vehicle file, or the name of one in config/vehicles")
      .type_name(io::kinds::kVehicle.value)
      .show_default();
  app.add_option("--control", options->control,
                 "control settings file, or the name of one in config/control: its limits and fence apply")
      .type_name(io::kinds::kControl.value)
      .show_default();
  app.add_option("--start", options->start, "start position of the vehicle: north and east, m")
      .finite()
      .expected(2);
  app.add_option("--supply", options->supply_voltage_v,
                 "battery voltage of the check, V; default: the low-battery threshold")
      .range(0.1, 100.0);
  app.add_option("--charge", options->state_of_charge, "state of charge of the battery at the start, 0 to 1")
      .range(0.0, 1.0)
      .show_default();
  app.add_flag("--json", options->json, "print JSON");
  return {app, [options] { return check_missions(*options); }};
}

}  // namespace swiftlet::ground
