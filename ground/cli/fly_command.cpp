#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/ground/cli/fly_vehicles.hpp"
#include "swiftlet/ground/client/network_options.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"

namespace swiftlet::ground {
namespace {

constexpr const char* kPx4Vehicle = "px4";  // --vehicle
constexpr std::size_t kMostVehicles = 50;   // flown and tested

void check(const FlyOptions& options, std::size_t vehicles) {
  const bool lockstep = options.clock == runtime::Clock::kLockstep;
  if (!lockstep && options.trace) throw io::InputError("--trace: requires --clock lockstep");
  if (vehicles > kMostVehicles) {
    throw io::InputError("--vehicle-name: names " + std::to_string(vehicles) + " vehicles, limit " +
                         std::to_string(kMostVehicles) + " per command");
  }
}

// A mission for each vehicle, or one for all.
void require_one_for_each(std::size_t missions, std::vector<std::string> vehicles) {
  if (missions == 1 || missions == vehicles.size()) return;
  const std::string counts = fmt::format("{} missions but {} {}; ", missions, vehicles.size(),
                                         vehicles.size() == 1 ? "vehicle" : "vehicles");
  if (missions < vehicles.size()) throw io::InputError(counts + "give one for all, or one for each");
  for (int number = 1; vehicles.size() < missions; ++number) {
    const std::string name = fmt::format("kl{}", number);
    if (std::find(vehicles.begin(), vehicles.end(), name) == vehicles.end()) vehicles.push_back(name);
  }
  throw io::InputError(fmt::format("{}add --vehicle-name {}", counts, fmt::join(vehicles, ",")));
}

// The vehicles start beside each other.
void require_room(double spacing_m, const plant::Vehicle& vehicle) {
  const double width_m = plant::width(vehicle);
  if (std::abs(spacing_m) >= width_m) return;
  throw io::InputError(
      fmt::format("--spacing: {:g} m puts the vehicles inside each other: a {} is up to {:.2f} m wide",
                  spacing_m, vehicle.name, width_m));
}

// Returns one launch configuration per vehicle. A single mission is flown by all vehicles; otherwise the i-th
// mission belongs to the i-th vehicle.
std::vector<LaunchConfiguration> plan_flights(const FlyOptions& options,
                                              const std::vector<std::string>& vehicles,
                                              const std::vector<StandingVehicle>& running) {
  const std::vector<std::string> missions = io::split_text(options.mission, ',');
  std::vector<LaunchConfiguration> plans;
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    FlyOptions one = options;
    one.mission = missions[missions.size() == 1 ? 0 : i];
    one.seed = options.seed + i;
    if (!running.empty()) {
      one.vehicle = running[i].files->vehicle();
      one.control = running[i].files->control();
    }
    if (vehicles.size() > 1) one.start_ned = start_of(i, vehicles.size(), options.spacing_m, options.per_row);
    plans.push_back(plan_flight(one));
  }
  if (vehicles.size() > 1 && options.launch_mode == LaunchMode::kStarted)
    require_room(options.spacing_m, plans.front().vehicle);
  return plans;
}

std::vector<std::string> vehicles_of(const FlyOptions& options) {
  return messages::vehicles_of_list(options.vehicles > 1 ? "kl1..kl" + std::to_string(options.vehicles)
                                                         : options.network.vehicle);
}

// `--vehicle px4` is PX4's first instance, with the default vehicle file. PX4 runs in the domain of its agent, 0 unless told,
// and is commanded above level actuators.
FlyOptions with_px4(FlyOptions options) {
  if (options.vehicle == kPx4Vehicle) {
    const bool simulates = options.clock == runtime::Clock::kLockstep || options.speed ||
                           options.imu_rate_hz > 0 || options.odometry != plant::OdometrySource::kNone;
    if (simulates)
      throw io::InputError(
          "--vehicle px4: PX4 is no simulation of swiftlet-plant, as --clock lockstep, --speed, "
          "--imu-rate and --odometry need");
    options.vehicle = FlyOptions().vehicle;
    options.px4_instance = options.px4_instance.value_or(0);
  }
  if (!options.px4_instance) return options;
  options.domain = std::max(options.domain, 0);
  if (options.level == plant::ControlLevel::kActuators) options.level = plant::ControlLevel::kAttitude;
  return options;
}

int fly(const FlyOptions& given) {
  const FlyOptions options = with_px4(given);
  const std::vector<std::string> vehicles = vehicles_of(options);
  check(options, vehicles.size());
  const std::vector<std::string> missions = io::split_text(options.mission, ',');
  require_one_for_each(missions.size(), vehicles);
  for (const std::string& mission : missions) (void)io::configuration_file(io::kinds::kMission, mission);
  const std::vector<StandingVehicle> running = running_vehicles(options, vehicles);
  return fly_vehicles(options, vehicles, plan_flights(options, vehicles, running), running);
}

}  // namespace

io::Command add_fly_command(runtime::CommandLine root, const std::string& version) {
  const auto options = std::make_shared<FlyOptions>();
  options->program = version;
  const runtime::CommandLine app =
      root.add_subcommand("fly", "Start plant, mocap and control on this computer, fly a mission and report");
  add_fly_options(app, *options);
  add_network_options(app, options->network, Vehicles::kSeveral);
  app.add_option("--spacing", options->spacing_m,
                 "distance between the start positions of several vehicles, m: a row from west to east about "
                 "the origin; each mission is shifted with its vehicle")
      .range(-100.0, 100.0)
      .show_default();
  app.add_option("--per-row", options->per_row,
                 "number of vehicles in a row; further rows stand to the north; default: all in one row")
      .range(1, static_cast<int>(kMostVehicles));
  app.add_option("--vehicles", options->vehicles, "number of vehicles, named kl1, kl2 and so on")
      .range(1, static_cast<int>(kMostVehicles))
      .excludes(app.option("--vehicle-name"));
  runtime::Option attach = add_launch_options(app, *options);
  runtime::Option px4 = app.add_option("--px4", options->px4_instance,
                                       "start swiftlet-px4 in place of plant, for this instance of PX4, "
                                       "which runs already with its agent "
                                       "in the domain (default: 0) and flies `swiftlet-plant --autopilot "
                                       "mavlink --truth-only`; --level is "
                                       "attitude unless told")
                            .range(0, 254)
                            .excludes(attach);
  for (const char* launch_option :
       {"--vehicle", "--control", "--simulation", "--seed", "--imu-rate", "--level", "--odometry",
        "--radio-delay", "--radio-jitter", "--radio-loss", "--clock", "--speed"}) {
    attach.excludes(app.option(launch_option));
  }
  for (const char* of_simulation : {"--imu-rate", "--odometry", "--clock", "--speed", "--spacing"})
    px4.excludes(app.option(of_simulation));
  app.footer(
      "Several vehicles (--vehicle-name kl1,kl2) start their missions at the same time. If one fails, the "
      "others land.\nThe paths are not checked for collisions between vehicles.\nCtrl-C lands; a second "
      "Ctrl-C ends the flight at once.\nexample: swiftlet fly square --record /tmp/square --json | jq "
      ".rms_3d_m\nexample: swiftlet fly square,zigzag --vehicle-name kl1,kl2\nexample: swiftlet fly hop.yaml "
      "--vehicles 16 "
      "--clock lockstep --spacing 0.4 --per-row 4\nexample: swiftlet fly square --vehicle px4 --level "
      "trajectory");
  return {app, [options] { return fly(*options); }};
}

}  // namespace swiftlet::ground
