#include <algorithm>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/ground/cli/fleet/fleet_commands.hpp"
#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/ground/cli/fly_vehicles.hpp"
#include "swiftlet/ground/client/network_options.hpp"
#include "swiftlet/ground/fleet/fleet_check.hpp"
#include "swiftlet/ground/fleet/fleet_watch.hpp"
#include "swiftlet/io/configuration.hpp"

namespace swiftlet::ground {
namespace {

struct FleetFlyOptions {
  std::string file;
  FlyOptions flight;
};

// The vehicles of one vehicle file beside each other, in the order of the fleet: one process serves them, with
// consecutive seeds.
std::vector<FleetVehicle> by_vehicle_file(std::vector<FleetVehicle> vehicles) {
  const std::vector<FleetVehicle> all = vehicles;
  const auto first_of = [&all](const FleetVehicle& vehicle) {
    return std::find_if(all.begin(), all.end(), [&](const FleetVehicle& one) {
      return one.member.vehicle_file == vehicle.member.vehicle_file;
    });
  };
  std::stable_sort(vehicles.begin(), vehicles.end(),
                   [&](const FleetVehicle& a, const FleetVehicle& b) { return first_of(a) < first_of(b); });
  return vehicles;
}

FlyOptions options_of(const FleetVehicle& vehicle, const FleetCheck& check, FlyOptions options) {
  options.mission = vehicle.member.mission_file.string();
  static_cast<io::FileOptions&>(options.reading) = vehicle.reading;
  options.vehicle = vehicle.member.vehicle_file.string();
  options.control = check.fleet.control_file.string();
  options.simulation = check.fleet.simulation_file.string();
  options.start_ned = vehicle.member.start_ned;
  options.mission_at_start = vehicle.member.mission_at_start;
  return options;
}

int fly_fleet(const FleetFlyOptions& options) {
  if (options.flight.trace && options.flight.clock != runtime::Clock::kLockstep)
    throw io::InputError("--trace: requires --clock lockstep");
  const FleetCheck check =
      check_fleet(load_fleet_file(io::configuration_file(io::kinds::kFleet, options.file)));
  if (!check.feasible()) throw io::InputError(check.fleet.file.string() + ": " + check.refusal());
  FlyOptions flight = options.flight;
  std::vector<std::string> names;
  std::vector<LaunchConfiguration> plans;
  std::vector<MonitoredVehicle> monitored;
  for (const FleetVehicle& vehicle : by_vehicle_file(check.vehicles)) {
    names.push_back(vehicle.member.name);
    monitored.push_back(vehicle.monitored);
    plans.push_back(plan_flight(options_of(vehicle, check, flight)));
    ++flight.seed;
  }
  if (options.flight.record.empty()) plans.front().folder = default_record_folder(check.fleet.name);
  // In lockstep the vehicles do not share one moment: each advances as its samples are answered. What the monitor sends then
  // would come at another moment in each run.
  StartWatch watch;
  const bool in_real_time = flight.clock == runtime::Clock::kRealtime && flight.speed.value_or(1.0) <= 1.0;
  if (in_real_time) {
    watch = [&monitored](std::vector<WatchedVehicle> vehicles, const std::function<bool()>& gives_up) {
      return std::make_shared<FleetWatch>(FleetMonitor(monitored), std::move(vehicles), gives_up);
    };
  } else if (names.size() > 1) {
    std::fprintf(
        stderr,
        "%s: flown without monitor, because it is not in real time: a vehicle that is paused or late, or "
        "leaves its path, is not waited for\n",
        check.fleet.name.c_str());
  }
  return fly_vehicles(options.flight, names, std::move(plans), running_vehicles(options.flight, names),
                      watch);
}

}  // namespace

io::Command add_fleet_fly_command(runtime::CommandLine fleet, const std::string& version) {
  const auto options = std::make_shared<FleetFlyOptions>();
  options->flight.program = version;
  const runtime::CommandLine app = fleet.add_subcommand(
      "fly", "Check a fleet file, start plant, mocap and control on this computer, fly all and report");
  app.add_option("file", options->file, "fleet file, or the name of one in config/fleets")
      .type_name(io::kinds::kFleet.value)
      .required();
  add_record_options(app, options->flight);
  add_network_options(app, options->flight.network, Vehicles::kSeveral);
  app.remove_option("--vehicle-name");
  app.add_option("--seed", options->flight.seed,
                 "random seed of the simulation of the first vehicle; each has the next number")
      .range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max())
      .show_default();
  runtime::Option attach = add_launch_options(app, options->flight);
  for (const char* launch_option : {"--seed", "--clock", "--speed"})
    attach.excludes(app.option(launch_option));
  app.footer(
      "All missions start at one time. If a vehicle fails, the others land.\nIn real time a monitor keeps "
      "the "
      "vehicles apart when one is paused or late, or leaves its path: the others wait or step aside. With "
      "--clock lockstep, or --speed above 1, it does not run: all fly on as planned.\nCtrl-C lands; a second "
      "Ctrl-C ends the flight at once.\nexample: swiftlet fleet fly swap6 --clock lockstep");
  return {app, [options] { return fly_fleet(*options); }};
}

}  // namespace swiftlet::ground
