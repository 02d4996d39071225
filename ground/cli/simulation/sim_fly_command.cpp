#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/ground/flight/flight_outcome.hpp"
#include "swiftlet/ground/flight/flight_settings.hpp"
#include "swiftlet/ground/flight/in_process_flight.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/ground/flight/simulated_recorder.hpp"

namespace swiftlet::ground {
namespace {

// Returns a sentence if the trace could not be written whole.
std::string close(runtime::FlightTrace& trace) {
  try {
    trace.close();
    return {};
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
}

int sim_fly(const FlyOptions& options) {
  LaunchConfiguration plan = plan_flight(options);
  ClosedLoop loop = closed_loop(plan, draw(plan, plan.seed).world, plan.seed);
  require_space(plan.folder, plan.record_bytes());
  const RecordFolder folder(plan.folder, existing_record(options), "--record", plan.input_files());
  plan.folder = folder.path();
  keep_settings(plan);
  std::optional<runtime::FlightTrace> trace;
  if (plan.trace) trace.emplace(plan.trace_file(), plan.vehicle.rotor_count());
  FlightRecord record(plan.record_capacity());
  if (plan.sensors) record.sensors = std::make_unique<SensorRecord>(plan.record_capacity());
  loop.sensors = record.sensors.get();
  std::optional<SimulatedRecorder> messages;
  if (plan.mcap) messages.emplace(loop, plan, options.program);
  ProgressLine progress;
  for (const std::string& assumption : plan.mission.assumptions)
    progress.say(plan.mission.name + ": " + assumption);
  const Interrupts interrupts;

  InProcessFlight flight = fly_in_process(
      loop, plan, plan.seed, record, trace ? &*trace : nullptr, [&] { return interrupts.count() > 0; },
      messages ? &*messages : nullptr);
  if (trace) flight.report.record_fault = close(*trace);
  if (messages) {
    const std::string fault = messages->finish();
    if (flight.report.record_fault.empty()) flight.report.record_fault = fault;
  }
  write_record(plan.folder, record, flight.report, flight.window, progress);
  return print_report(flight.report, options.json, progress);
}

}  // namespace

Command add_sim_fly_command(runtime::CommandLine sim, const std::string& version) {
  const auto options = std::make_shared<FlyOptions>();
  options->program = version;
  options->launch_mode = LaunchMode::kInProcess;
  const runtime::CommandLine app =
      sim.add_subcommand("fly", "Fly a mission in one process, as fast as possible");
  add_fly_options(app, *options);
  add_dispersion_option(app, *options);
  app.add_flag("--mcap", options->mcap,
               "write flight.mcap, the messages of the flight, as `swiftlet fly --mcap` does");
  app.add_flag("--trace", options->trace,
               "write trace.csv, which holds every sample and command bit for bit, to compare flights");
  app.footer(
      "The flight equals that of `swiftlet fly --clock lockstep` with the same files and seed.\n\n"
      "example: swiftlet sim fly square --seed 7 --json | jq .rms_3d_m");
  return {app, [options] { return sim_fly(*options); }};
}

}  // namespace swiftlet::ground
