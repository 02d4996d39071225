#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <exception>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "swiftlet/ground/cli/check/preflight.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/ground/command_line/network_options.hpp"
#include "swiftlet/ground/flight/attached_vehicle.hpp"
#include "swiftlet/ground/flight/flight_outcome.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/ground/flight/message_record.hpp"
#include "swiftlet/ground/flight/process_flight.hpp"
#include "swiftlet/ground/flight/process_group.hpp"
#include "swiftlet/ground/terminal/fleet_progress.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/discovery/flight_reservation.hpp"
#include "swiftlet/services/dds/shared_memory.hpp"
#include "swiftlet/services/dds/vehicle_list.hpp"
#include "swiftlet/services/runtime/split_text.hpp"

namespace swiftlet::ground {
namespace {

constexpr const char* kPx4Vehicle = "px4";  // --vehicle
constexpr std::size_t kMostVehicles = 50;   // flown and tested

void check(const FlyOptions& options, std::size_t vehicles) {
  const bool lockstep = options.clock == runtime::Clock::kLockstep;
  if (!lockstep && options.trace) throw InputError("--trace: requires --clock lockstep");
  if (vehicles > kMostVehicles) {
    throw InputError("--vehicle-name: names " + std::to_string(vehicles) + " vehicles, limit " +
                     std::to_string(kMostVehicles) + " per command");
  }
}

// A mission for each vehicle, or one for all.
void require_one_for_each(std::size_t missions, std::vector<std::string> vehicles) {
  if (missions == 1 || missions == vehicles.size()) return;
  const std::string counts = fmt::format("{} missions but {} {}; ", missions, vehicles.size(),
                                         vehicles.size() == 1 ? "vehicle" : "vehicles");
  if (missions < vehicles.size()) throw InputError(counts + "give one for all, or one for each");
  for (int number = 1; vehicles.size() < missions; ++number) {
    const std::string name = fmt::format("kl{}", number);
    if (std::find(vehicles.begin(), vehicles.end(), name) == vehicles.end()) vehicles.push_back(name);
  }
  throw InputError(fmt::format("{}add --vehicle-name {}", counts, fmt::join(vehicles, ",")));
}

// The vehicles start beside each other.
void require_room(double spacing_m, const plant::Vehicle& vehicle) {
  const double width_m = plant::width(vehicle);
  if (std::abs(spacing_m) >= width_m) return;
  throw InputError(
      fmt::format("--spacing: {:g} m puts the vehicles inside each other: a {} is up to {:.2f} m wide",
                  spacing_m, vehicle.name, width_m));
}

// Returns one launch configuration per vehicle. A single mission is flown by all vehicles; otherwise the i-th
// mission belongs to the i-th vehicle.
std::vector<LaunchConfiguration> plan_flights(const FlyOptions& options,
                                              const std::vector<std::string>& vehicles) {
  const std::vector<std::string> missions = runtime::split_text(options.mission, ',');
  require_one_for_each(missions.size(), vehicles);
  std::vector<LaunchConfiguration> plans;
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    FlyOptions one = options;
    one.mission = missions[missions.size() == 1 ? 0 : i];
    one.seed = options.seed + i;
    if (vehicles.size() > 1) one.start_ned = start_of(i, vehicles.size(), options.spacing_m, options.per_row);
    plans.push_back(plan_flight(one));
  }
  if (vehicles.size() > 1 && options.launch_mode == LaunchMode::kStarted)
    require_room(options.spacing_m, plans.front().vehicle);
  return plans;
}

// Makes the folder of the record, with one inside for each of several vehicles.
std::unique_ptr<RecordFolder> make_record(const FlyOptions& options, const std::vector<std::string>& vehicles,
                                          std::vector<LaunchConfiguration>& plans) {
  std::uintmax_t needed_bytes = 0;
  for (const LaunchConfiguration& plan : plans) needed_bytes += plan.record_bytes();
  require_space(plans.front().folder, needed_bytes);
  std::vector<std::filesystem::path> inputs;
  for (const LaunchConfiguration& plan : plans) {
    const std::vector<std::filesystem::path> files = plan.input_files();
    inputs.insert(inputs.end(), files.begin(), files.end());
  }
  auto folder =
      std::make_unique<RecordFolder>(plans.front().folder, existing_record(options), "--record", inputs);
  for (std::size_t i = 0; i < plans.size(); ++i)
    plans[i].folder = plans.size() == 1 ? folder->path() : folder->folder_of(vehicles[i]);
  return folder;
}

// Calls work(i) for each flight, each in a thread of its own. Throws the exception of the first that fails.
template <class Work>
void for_each_at_once(std::size_t flights, const Work& work) {
  std::vector<std::future<void>> working;
  for (std::size_t i = 0; i < flights; ++i)
    working.push_back(std::async(std::launch::async, [&work, i] { work(i); }));
  for (std::future<void>& one : working) one.wait();
  for (std::future<void>& one : working) one.get();
}

// Flies all vehicles at the same time, ends the processes and writes the records.
void fly_together(std::deque<ProcessFlight>& flights, ProcessGroup& processes, const Interrupts& interrupts,
                  ProgressLine& progress) {
  std::vector<std::string> names;
  names.reserve(flights.size());
  for (const ProcessFlight& flight : flights) names.push_back(flight.vehicle_name());
  FleetProgress shares(progress, names);
  StartBarrier barrier(flights.size());
  std::exception_ptr fault;
  try {
    for_each_at_once(flights.size(),
                     [&](std::size_t i) { flights[i].fly(interrupts, &barrier, shares.of(i)); });
  } catch (const std::exception&) {
    fault = std::current_exception();  // once the records are written
  }
  std::vector<std::string> errors = processes.stop();
  const bool any_failed = std::any_of(flights.begin(), flights.end(), [](const ProcessFlight& flight) {
    return !flight.report().reason.empty();
  });
  if (any_failed) {  // the exit status of a process that serves several may be due to that flight
    for (const std::string& error : errors) progress.say(error);
    errors.clear();
  }
  for_each_at_once(flights.size(), [&](std::size_t i) { flights[i].finish(errors, shares.of(i)); });
  if (fault) std::rethrow_exception(fault);
}

// Throws unless the running vehicles are on the ground and can fly their missions. What is not known of one is said.
void require_flyable_by_running(const comms::NodeSettings& network, const std::vector<std::string>& vehicles,
                                const std::vector<LaunchConfiguration>& plans, const FileOptions& reading) {
  const std::vector<std::optional<ReportedModel>> models = require_on_ground(network, vehicles);
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const KnownVehicle vehicle = known_vehicle(models[i]);
    if (vehicle.model) {
      require_flyable(plans[i], *vehicle.model, reading);
    } else {
      std::fprintf(stderr, "%s: its rotors are not checked: %s\n", vehicles[i].c_str(),
                   vehicle.unknown.c_str());
    }
  }
}

std::vector<std::string> vehicles_of(const FlyOptions& options) {
  return comms::vehicles_of_list(options.vehicles > 1 ? "kl1..kl" + std::to_string(options.vehicles)
                                                      : options.network.vehicle);
}

// `--vehicle px4` is PX4's first instance, with the default vehicle file. PX4 runs in the domain of its agent, 0 unless told,
// and is commanded above level actuators.
FlyOptions with_px4(FlyOptions options) {
  if (options.vehicle == kPx4Vehicle) {
    const bool simulates = options.clock == runtime::Clock::kLockstep || options.speed || options.sensors ||
                           options.imu_rate_hz > 0 || options.odometry != plant::OdometrySource::kNone;
    if (simulates)
      throw InputError(
          "--vehicle px4: PX4 is no simulation of swiftlet-plant, as --clock lockstep, --speed, --sensors, "
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
  Fleet fleet{vehicles,       plan_flights(options, vehicles), options.spacing_m, options.per_row, {},
              options.program};
  std::vector<LaunchConfiguration>& plans = fleet.plans;

  const bool attached = options.launch_mode == LaunchMode::kAttached;
  std::optional<comms::DomainLock> domain_lock;
  if (options.domain < 0 && !attached) domain_lock.emplace();
  comms::NodeSettings network = options.network;
  network.domain = domain_lock ? domain_lock->domain() : std::max(options.domain, 0);
  const bool is_alone = !attached && !options.px4_instance;  // all processes are started here
  network.localhost_only = network.localhost_only || is_alone;
  if (attached) require_flyable_by_running(network, vehicles, plans, options.reading);
  if (attached && !options.skip_check) require_sound_vehicles(network, vehicles);
  // In a domain that others may use, the vehicles must not live already.
  std::optional<comms::FlightReservation> reservation;
  if (!domain_lock && !attached) reservation.emplace(network, vehicles);
  const std::unique_ptr<RecordFolder> record = make_record(options, vehicles, plans);

  fleet.folder = record->path();

  ProgressLine progress;
  const Interrupts interrupts;
  std::optional<MessageRecord> messages;  // receives from the first message on
  if (options.mcap) messages.emplace(network, fleet);
  ProcessGroup processes(ground::processes(fleet, network));
  comms::NodeSettings own = network;
  own.deadlines = options.clock != runtime::Clock::kLockstep;
  const comms::Participant participant(own, vehicles);
  std::deque<ProcessFlight> flights;
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const LaunchConfiguration& plan = plans[i];
    for (const std::string& assumption : plan.mission.assumptions)
      progress.say(plan.mission.name + ": " + assumption);
    network.vehicle = vehicles[i];
    progress.say("flying " + plan.mission.name +
                 (plan.launch_mode == LaunchMode::kAttached ? "" : " with " + plan.vehicle.name) + ": " +
                 network.vehicle + " in domain " + std::to_string(network.domain) +
                 (network.localhost_only ? " (--localhost-only)" : "") + ", record in " +
                 plan.folder.string());
    own.vehicle = vehicles[i];
    flights.emplace_back(std::move(plans[i]), own, processes, participant);
  }
  if (flights.size() == 1) {
    flights.front().fly(interrupts, nullptr, progress);
    flights.front().finish(processes.stop(), progress);
  } else {
    fly_together(flights, processes, interrupts, progress);
  }
  std::string incomplete;
  if (messages) incomplete = messages->finish();
  if (!incomplete.empty()) progress.say("swiftlet: the record of the messages is incomplete: " + incomplete);
  // A killed process leaves its shared memory segments behind.
  if (network.transport == comms::Transport::kSharedMemory) comms::remove_stale_shared_memory();

  if (flights.size() == 1) return print_report(flights.front().report(), options.json, progress);
  std::vector<FlightReport> reports;
  reports.reserve(flights.size());
  for (const ProcessFlight& flight : flights) reports.push_back(flight.report());
  return print_report(reports, options.json, progress);
}

}  // namespace

Command add_fly_command(runtime::CommandLine root, const std::string& version) {
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
  app.option("--localhost-only")
      .describe(
          "with --attach or --px4: use the loopback interface only, without multicast; otherwise always set");
  app.remove_option("--domain");  // added below with another default
  app.add_option("--domain", options->domain, "DDS domain; default: a free one")
      .environment("ROS_DOMAIN_ID")
      .range(0, 232);
  runtime::Option attach = app.add_flag(
      "--attach", [options] { options->launch_mode = LaunchMode::kAttached; },
      "start no processes: use the plant, mocap and control that run in the domain (default: 0)");
  app.add_flag("--skip-check", options->skip_check,
               "with --attach: arm the vehicle although it was not checked, see `swiftlet check vehicle`")
      .needs(attach);
  runtime::Option px4 = app.add_option("--px4", options->px4_instance,
                                       "start swiftlet-px4 in place of plant, for this instance of PX4, "
                                       "which runs already with its agent "
                                       "in the domain (default: 0) and flies `swiftlet-plant --autopilot "
                                       "mavlink --truth-only`; --level is "
                                       "attitude unless told")
                            .range(0, 254)
                            .excludes(attach);
  runtime::add_clock_option(app, options->clock);
  app.add_option(
         "--speed", options->speed,
         "simulation speed factor (1 = real time); default: 1, or with --clock lockstep as fast as possible")
      .range(0.01, 100.0);
  app.add_flag("--mcap", options->mcap,
               "write flight.mcap, every message of the flight, as `swiftlet record` does");
  app.add_flag("--trace", options->trace,
               "lockstep only: write trace.csv, which holds every sample and command bit for bit");
  for (const char* launch_option :
       {"--vehicle", "--simulation", "--seed", "--imu-rate", "--level", "--odometry", "--radio-delay",
        "--radio-jitter", "--radio-loss", "--clock", "--speed", "--as-fast-as-possible"}) {
    attach.excludes(app.option(launch_option));
  }
  for (const char* of_simulation :
       {"--imu-rate", "--odometry", "--clock", "--speed", "--spacing", "--sensors"})
    px4.excludes(app.option(of_simulation));
  // Processes that it starts are on this host.
  for (const char* network_option :
       {"--network", "--peer", "--discovery-server", "--interface", "--dds-profile"})
    app.option(network_option).needs(attach);
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
