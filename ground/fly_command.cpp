#include <algorithm>
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
#include "ground/flight_files.hpp"
#include "ground/flight_plan.hpp"
#include "ground/flight_report.hpp"
#include "ground/interrupts.hpp"
#include "ground/network_options.hpp"
#include "services/comms/domain_claim.hpp"
#include "services/comms/shared_memory.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kSpareS = 60.0;  // of the record, beyond 1.5 times the planned duration

std::size_t record_capacity(const FlightPlan& plan) {
  return static_cast<std::size_t>((1.5 * plan.planned_duration_s + kSpareS) * plan.imu_rate_hz);
}

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

// Why a mission that was flown to its end does not count as completed; empty if it does.
std::string shortfall(const FlightReport& report, Window window) {
  char text[160];
  if (!enough_samples(report.errors, window)) {
    std::snprintf(text, sizeof text,
                  "too little telemetry to judge it: %zu samples matched of %.0f, longest gap %.2f s (at "
                  "least %.0f %%, at most %.2f s)",
                  report.errors.matched, window.duration_s() * report.imu_rate_hz,
                  report.errors.longest_gap_s, kLeastMatchedFraction * 100.0, kLongestGapS);
    return text;
  }
  if (!std::isfinite(report.errors.rms_3d_m)) return "the ground truth is not finite";
  if (report.errors.peak_3d_m > report.tolerance_m) {
    std::snprintf(text, sizeof text, "the peak tracking error was %.3f m, the tolerance is %.3f m",
                  report.errors.peak_3d_m, report.tolerance_m);
    return text;
  }
  return {};
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
  report.mission = plan.mission.name;
  report.vehicle = plan.vehicle_name;
  report.control = plan.control_name;
  report.seed = plan.seed;
  report.record_dir = plan.folder.string();
  report.tolerance_m = plan.mission.tolerance_m;

  const Interrupts interrupts;
  Fleet fleet(processes(plan, network));
  std::optional<Window> window;
  {
    Client client(network, &record);
    try {
      Flight(client, record, plan.mission, plan.planned_duration_s,
             {[&] { return fleet.casualty(); }, [&] { return interrupts.count(); }}, progress)
          .run();
    } catch (const FlightFailure& failure) {
      report.reason = failure.what();
    }
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
  report.errors = tracking_errors(record.truth, record.reference, flown.window);
  if (report.reason.empty()) report.reason = shortfall(report, flown.window);
  report.completed = report.reason.empty();
  return flown;
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError("--record " + folder.string() + ": the folder cannot be made: " + error.message());
}

void keep_record(const FlightPlan& plan, const FlightRecord& record, const Flown& flown,
                 ProgressLine& progress) {
  write_flight_csv(plan.folder / "flight.csv", record, flown.window);
  write_report_json(plan.folder / "report.json", flown.report);
  if (flown.report.errors.matched == 0) return;
  const std::string no_picture = draw_flight(plan.folder, flown.report, flown.window);
  if (!no_picture.empty()) progress.say(no_picture);
}

int fly(const FlyOptions& options) {
  const FlightPlan plan = plan_flight(options);
  make_folder(plan.folder);

  std::optional<comms::DomainClaim> claim;
  if (options.domain < 0 && !options.attach) claim.emplace();
  comms::NodeSettings network = options.network;
  network.domain = claim ? claim->domain() : std::max(options.domain, 0);

  ProgressLine progress;
  progress.say("flying " + plan.mission.name + (plan.attach ? "" : " with " + plan.vehicle_name) + ": " +
               network.vehicle + " in domain " + std::to_string(network.domain) +
               (network.localhost_only ? " (--localhost-only)" : "") + ", record in " + plan.folder.string());
  FlightRecord record(record_capacity(plan));
  const Flown flown = fly_mission(plan, network, record, progress);
  keep_record(plan, record, flown, progress);
  progress.close();

  if (options.json) {
    std::printf("%s\n", to_json(flown.report).dump().c_str());
    if (!flown.report.completed) progress.say("swiftlet: " + flown.report.reason);
  } else {
    std::fputs(to_text(flown.report).c_str(), flown.report.completed ? stdout : stderr);
  }
  return flown.report.completed ? kDone : kFailed;
}

}  // namespace

Command add_fly_command(CLI::App& root) {
  const auto options = std::make_shared<FlyOptions>();
  options->network.localhost_only = true;
  CLI::App* const app = root.add_subcommand(
      "fly", "Start plant, mocap and control on this computer, fly a mission, and report");
  app->add_option("mission", options->mission, "mission file, or the name of one in the configuration")
      ->capture_default_str();
  app->add_option("--vehicle", options->vehicle, "vehicle file or name")->capture_default_str();
  app->add_option("--control", options->control,
                  "control settings, file or name: motor_lag, or paper for the paper's own loops")
      ->capture_default_str();
  app->add_option("--simulation", options->simulation, "simulation settings, file or name")
      ->capture_default_str();
  app->add_option(
      "--record", options->record,
      "folder for flight.csv, report.json, flight.png and logs; flights/<date>-<mission> unless given");
  app->add_option("--seed", options->seed, "of all that is random in the simulation")
      ->check(CLI::Range(std::numeric_limits<std::int64_t>::max()))
      ->capture_default_str();
  app->add_option("--imu-rate", options->imu_rate_hz,
                  "IMU and inner-loop rate, Hz; as the simulation file says unless given")
      ->check(CLI::IsMember({500, 1000}));
  add_network_options(*app, options->network);
  app->remove_option(app->get_option("--localhost-only"));  // it stays there
  app->remove_option(app->get_option("--domain"));          // whose default is not that of a flight
  app->add_option("--domain", options->domain, "DDS domain; a free one unless given")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0, 232));
  CLI::Option* const attach = app->add_flag(
      "--attach", options->attach,
      "start nothing: fly with the plant, mocap and control that run in the domain (0 unless given)");
  for (const char* of_the_started : {"--vehicle", "--simulation", "--seed", "--imu-rate"}) {
    attach->excludes(app->get_option(of_the_started));
  }
  app->add_flag("--network{false}", options->network.localhost_only, "use all interfaces, not loopback alone")
      ->needs(attach);
  app->add_flag("--json", options->json, "print one JSON object instead of the summary");
  app->footer(
      "Ctrl-C lands; a second Ctrl-C ends at once.\nexample: swiftlet fly square --record /tmp/square --json "
      "| jq .rms_3d_m");
  return {app, [options] { return fly(*options); }};
}

}  // namespace swiftlet::ground
