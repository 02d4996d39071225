#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "ground/client.hpp"
#include "ground/commands.hpp"
#include "ground/fleet.hpp"
#include "ground/flight.hpp"
#include "ground/flight_conclusion.hpp"
#include "ground/flight_plan.hpp"
#include "ground/flight_settings.hpp"
#include "ground/flight_window.hpp"
#include "ground/fly_options.hpp"
#include "ground/interrupts.hpp"
#include "ground/network_options.hpp"
#include "services/comms/domain_claim.hpp"
#include "services/comms/shared_memory.hpp"

namespace swiftlet::ground {
namespace {

void take_figures(const View& view, FlightReport& report) {
  const auto& control = view.control.message;
  report.control_rate_hz = control.rate_hz();
  report.cycles = control.cycles();
  report.deadline_misses = control.deadline_misses();
  report.step_time_max_us = control.step_time_max_us();
  report.realtime_scheduling = control.realtime_scheduling();
  const auto& vehicle = view.vehicle.message;
  if (vehicle.name().size() > 0) report.vehicle = vehicle.name().c_str();
  report.imu_rate_hz = vehicle.imu_rate_hz();
  report.unanswered = vehicle.unanswered();
  report.sense_to_actuate = {vehicle.sense_to_actuate_p50_us(), vehicle.sense_to_actuate_p99_us(),
                             vehicle.sense_to_actuate_max_us()};
}

struct Flown {
  FlightReport report;
  Window window;
};

// Everything between the first process that starts and the last that ends.
Flown fly_mission(const FlightPlan& plan, const comms::NodeSettings& network, FlightRecord& record,
                  ProgressLine& progress) {
  Flown flown;
  FlightReport& report = flown.report;
  report = report_of(plan);

  const Interrupts interrupts;
  Fleet fleet(processes(plan, network));
  std::optional<Window> window;
  {
    Client client(network, &record);
    const auto start = Clock::now();
    try {
      Flight(client, record, plan.mission, plan.planned_duration_s, plan.clock,
             {[&] { return fleet.casualty(); }, [&] { return interrupts.count(); }}, progress)
          .run();
    } catch (const FlightFailure& failure) {
      report.reason = failure.what();
    }
    report.wall_s = std::chrono::duration<double>(Clock::now() - start).count();
    if (!record.truth.empty()) report.simulated_s = static_cast<double>(record.truth.back().stamp_ns) * 1e-9;
    take_figures(client.view(), report);
    window = mission_window(record, client.mission_id(), plan.mission.mission);
    if (window) report.duration_s = mission_duration_s(record, client.mission_id(), *window);
  }
  for (const std::string& complaint : fleet.stop()) {
    if (report.reason.empty()) report.reason = "after the flight, " + complaint;
  }

  // What a process that was killed left there.
  if (network.transport == comms::Transport::kSharedMemory) comms::remove_stale_shared_memory();

  flown.window = window.value_or(Window{});
  judge(report, record, flown.window);
  return flown;
}

void check(const FlyOptions& options) {
  const bool lockstep = options.clock == runtime::Clock::kLockstep;
  if (lockstep && options.speed != 1.0)
    throw InputError("--speed: lockstep goes as fast as the answers come");
  if (!lockstep && options.trace) throw InputError("--trace: needs --clock lockstep");
}

int fly(const FlyOptions& options) {
  check(options);
  const FlightPlan plan = plan_flight(options);
  make_record_folder(plan.folder);
  keep_settings(plan);

  std::optional<comms::DomainClaim> claim;
  if (options.domain < 0 && plan.parties == Parties::kStarted) claim.emplace();
  comms::NodeSettings network = options.network;
  network.domain = claim ? claim->domain() : std::max(options.domain, 0);

  ProgressLine progress;
  for (const std::string& assumption : plan.mission.assumptions)
    progress.say(plan.mission.name + ": " + assumption);
  progress.say("flying " + plan.mission.name +
               (plan.parties == Parties::kAttached ? "" : " with " + plan.vehicle.name) + ": " +
               network.vehicle + " in domain " + std::to_string(network.domain) +
               (network.localhost_only ? " (--localhost-only)" : "") + ", record in " + plan.folder.string());
  FlightRecord record(plan.record_capacity());
  if (plan.sensors) record.sensors = std::make_unique<SensorRecord>(plan.record_capacity());
  const Flown flown = fly_mission(plan, network, record, progress);
  keep_record(plan.folder, record, flown.report, flown.window, progress);
  return tell(flown.report, options.json, progress);
}

}  // namespace

Command add_fly_command(CLI::App& root) {
  const auto options = std::make_shared<FlyOptions>();
  options->network.localhost_only = true;
  CLI::App* const app = root.add_subcommand(
      "fly", "Start plant, mocap and control on this computer, fly a mission, and report");
  add_fly_options(*app, *options);
  add_network_options(*app, options->network);
  app->remove_option(app->get_option("--localhost-only"));  // it stays there
  app->remove_option(app->get_option("--domain"));          // whose default is not that of a flight
  app->add_option("--domain", options->domain, "DDS domain; a free one unless given")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0, 232));
  CLI::Option* const attach = app->add_flag_function(
      "--attach", [options](std::int64_t) { options->parties = Parties::kAttached; },
      "start nothing: fly with the plant, mocap and control that run in the domain (0 unless given)");
  runtime::add_clock_option(*app, options->clock);
  app->add_option("--speed", options->speed, "of simulated time against real time")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
  app->add_flag("--trace", options->trace,
                "lockstep: keep trace.csv in the record, every sample and command to the last bit");
  for (const char* of_the_started :
       {"--vehicle", "--simulation", "--seed", "--imu-rate", "--clock", "--speed"}) {
    attach->excludes(app->get_option(of_the_started));
  }
  app->add_flag("--network{false}", options->network.localhost_only, "use all interfaces, not loopback alone")
      ->needs(attach);
  app->footer(
      "Ctrl-C lands; a second Ctrl-C ends at once.\nexample: swiftlet fly square --record /tmp/square --json "
      "| jq .rms_3d_m");
  return {app, [options] { return fly(*options); }};
}

}  // namespace swiftlet::ground
