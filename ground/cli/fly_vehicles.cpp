#include "swiftlet/ground/cli/fly_vehicles.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <exception>
#include <future>
#include <memory>
#include <optional>
#include <utility>

#include "swiftlet/ground/cli/hover_test.hpp"
#include "swiftlet/ground/cli/live_view.hpp"
#include "swiftlet/ground/cli/preflight.hpp"
#include "swiftlet/ground/flight/flight_outcome.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/ground/flight/message_record.hpp"
#include "swiftlet/ground/flight/process_flight.hpp"
#include "swiftlet/ground/flight/process_group.hpp"
#include "swiftlet/ground/terminal/fleet_progress.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/discovery/sole_source.hpp"

namespace swiftlet::ground {
namespace {

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
void fly_together(std::deque<ProcessFlight>& flights, ProcessGroup& processes, MessageRecord& messages,
                  const std::filesystem::path& folder, const StartWatch& start_watch,
                  const Interrupts& interrupts, io::ProgressLine& progress) {
  std::vector<std::string> names;
  names.reserve(flights.size());
  for (const ProcessFlight& flight : flights) names.push_back(flight.vehicle_name());
  FleetProgress shares(progress, names);
  StartBarrier barrier(flights.size());
  std::shared_ptr<void> watch;
  if (start_watch) {
    std::vector<WatchedVehicle> watched;
    for (std::size_t i = 0; i < flights.size(); ++i) watched.push_back({flights[i].client(), &shares.of(i)});
    watch = start_watch(std::move(watched),
                        [&] { return barrier.failure().has_value() || interrupts.count() > 0; });
  }
  std::exception_ptr fault;
  try {
    for_each_at_once(flights.size(),
                     [&](std::size_t i) { flights[i].fly(interrupts, &barrier, shares.of(i)); });
  } catch (const std::exception&) {
    fault = std::current_exception();  // once the records are written
  }
  watch.reset();
  std::vector<std::string> errors = processes.stop();
  const bool any_failed = std::any_of(flights.begin(), flights.end(), [](const ProcessFlight& flight) {
    return !flight.report().reason.empty();
  });
  if (any_failed) {  // the exit status of a process that serves several may be due to that flight
    for (const std::string& error : errors) progress.say(error);
    errors.clear();
  }
  const std::string record_fault = messages.finish();
  for_each_at_once(flights.size(),
                   [&](std::size_t i) { flights[i].finish(errors, record_fault, folder, shares.of(i)); });
  if (fault) std::rethrow_exception(fault);
}

dds::NodeSettings network_of(const FlyOptions& options) {
  dds::NodeSettings network = options.network;
  network.domain = std::max(options.domain, 0);
  return network;
}

// Takes what the running vehicles fly with into the plans. Throws unless they can fly their missions from where they stand.
void take_running(const std::vector<StandingVehicle>& running, const io::FileOptions& reading,
                  std::vector<LaunchConfiguration>& plans) {
  for (std::size_t i = 0; i < plans.size(); ++i) {
    LaunchConfiguration& plan = plans[i];
    plan.start_ned = running[i].start_ned.value_or(plan.start_ned);
    plan.vehicle_file = running[i].files->vehicle();
    plan.control_file = running[i].files->control();
    plan.vehicle = io::load_vehicle(plan.vehicle_file);
    plan.control = io::load_control_settings(plan.control_file);
    plan.planned_duration_s = require_flyable(plan, reading);
  }
}

}  // namespace

std::vector<StandingVehicle> running_vehicles(const FlyOptions& options,
                                              const std::vector<std::string>& vehicles) {
  if (options.launch_mode != LaunchMode::kAttached) return {};
  return require_on_ground(network_of(options), vehicles);
}

int fly_vehicles(const FlyOptions& options, const std::vector<std::string>& vehicles,
                 std::vector<LaunchConfiguration> planned, const std::vector<StandingVehicle>& running,
                 const StartWatch& start_watch) {
  Fleet fleet{vehicles, std::move(planned), {}, options.program};
  std::vector<LaunchConfiguration>& plans = fleet.plans;

  const bool attached = options.launch_mode == LaunchMode::kAttached;
  std::optional<dds::DomainLock> domain_lock;
  if (options.domain < 0 && !attached) domain_lock.emplace();
  dds::NodeSettings network = network_of(options);
  if (domain_lock) network.domain = domain_lock->domain();
  const bool is_alone = !attached && !options.px4_instance;  // all processes are started here
  network.localhost_only = network.localhost_only || is_alone;
  if (attached) take_running(running, options.reading, plans);
  if (attached && !options.skip_check) require_sound_vehicles(network, vehicles);
  if (attached && !options.skip_hover_test) require_hover_tests(network, vehicles);
  // In a domain that others may use, the vehicles must not live already.
  std::optional<dds::FlightReservation> reservation;
  if (!domain_lock && !attached) reservation.emplace(network, vehicles);
  const std::unique_ptr<RecordFolder> record = make_record(options, vehicles, plans);

  fleet.folder = record->path();

  io::ProgressLine progress;
  const Interrupts interrupts;
  MessageRecord messages(network, fleet);  // receives from the first message on
  std::optional<LiveView> view;
  if (options.view) {
    view.emplace(network, vehicles, record->path());
    progress.say("live page: " + view->url());
  }
  ProcessGroup processes(ground::processes(fleet, network));
  const dds::Participant participant(network, vehicles);
  std::deque<ProcessFlight> flights;
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const LaunchConfiguration& plan = plans[i];
    for (const std::string& assumption : plan.mission.assumptions)
      progress.say(plan.mission.name + ": " + assumption);
    network.vehicle = vehicles[i];
    progress.say("flying " + plan.mission.name +
                 (plan.launch_mode == LaunchMode::kAttached ? "" : " with " + plan.vehicle.name) + ": " +
                 network.vehicle + " in domain " + std::to_string(network.domain) +
                 (network.on_loopback() ? " on this host" : "") + ", record in " + plan.folder.string());
    flights.emplace_back(std::move(plans[i]), network, processes, participant, messages);
  }
  if (flights.size() == 1) {
    flights.front().fly(interrupts, nullptr, progress);
    const std::vector<std::string> end_errors = processes.stop();
    flights.front().finish(end_errors, messages.finish(), fleet.folder, progress);
  } else {
    fly_together(flights, processes, messages, fleet.folder, start_watch, interrupts, progress);
  }
  if (flights.size() == 1) return print_report(flights.front().report(), options.json, progress);
  std::vector<analysis::FlightReport> reports;
  reports.reserve(flights.size());
  for (const ProcessFlight& flight : flights) reports.push_back(flight.report());
  return print_report(reports, options.json, progress);
}

}  // namespace swiftlet::ground
