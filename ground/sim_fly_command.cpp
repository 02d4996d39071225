#include <chrono>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "ground/commands.hpp"
#include "ground/flight_conclusion.hpp"
#include "ground/flight_plan.hpp"
#include "ground/flight_window.hpp"
#include "ground/fly_options.hpp"
#include "ground/interrupts.hpp"
#include "ground/simulation/simulated_flight.hpp"

namespace swiftlet::ground {
namespace {

int sim_fly(const FlyOptions& options) {
  FlightPlan plan = plan_flight(options);
  plan.mission.mission.id = 1;
  ClosedLoop loop(plan.vehicle, plan.simulation, plan.control, plan.seed);
  make_record_folder(plan.folder);
  std::optional<runtime::FlightTrace> trace;
  if (!plan.trace_file.empty()) trace.emplace(plan.trace_file, plan.vehicle.rotor_count());
  FlightRecord record(plan.record_capacity());
  ProgressLine progress;
  const Interrupts interrupts;

  FlightReport report = report_of(plan);
  const auto start = std::chrono::steady_clock::now();
  const SimulatedFlight flight =
      fly(loop, plan.mission.mission, plan.planned_duration_s,
          {&record, trace ? &*trace : nullptr, [&] { return interrupts.count() > 0; }});
  report.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (trace) trace->close();

  report.simulated_s = flight.simulated_s;
  report.reason = flight.reason;
  const auto window = mission_window(record, plan.mission.mission.id, plan.mission.mission);
  if (window) report.duration_s = mission_duration_s(record, plan.mission.mission.id, *window);
  judge(report, record, window.value_or(Window{}));
  keep_record(plan.folder, record, report, window.value_or(Window{}), progress);
  return tell(report, options.json, progress);
}

}  // namespace

Command add_sim_fly_command(CLI::App& sim) {
  const auto options = std::make_shared<FlyOptions>();
  options->parties = Parties::kInProcess;
  CLI::App* const app = sim.add_subcommand(
      "fly", "Fly a mission in this process, as fast as it goes; the same flight as in lockstep");
  add_fly_options(*app, *options);
  app->add_flag(
      "--trace", options->trace,
      "keep trace.csv in the record: every sample and command to the last bit, to compare flights by");
  app->footer("example: swiftlet sim fly square --seed 7 --json | jq .rms_3d_m");
  return {app, [options] { return sim_fly(*options); }};
}

}  // namespace swiftlet::ground
