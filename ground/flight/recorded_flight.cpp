#include "swiftlet/ground/flight/recorded_flight.hpp"

#include <optional>
#include <stdexcept>
#include <string>

#include "swiftlet/ground/flight/flight_outcome.hpp"
#include "swiftlet/ground/flight/flight_settings.hpp"
#include "swiftlet/ground/flight/in_process_flight.hpp"
#include "swiftlet/ground/flight/record_folder.hpp"
#include "swiftlet/ground/flight/simulated_recorder.hpp"
#include "swiftlet/plant/simulation/no_effect.hpp"
#include "swiftlet/record/file/recorded_faults.hpp"

namespace swiftlet::ground {
namespace {

// Returns a sentence if the trace could not be written whole.
std::string close(record::FlightTrace& trace) {
  try {
    trace.close();
    return {};
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
}

}  // namespace

analysis::FlightReport fly_and_record(LaunchConfiguration plan, const FlyOptions& options,
                                      record::Flight& flight, const std::function<bool()>& cancelled,
                                      io::Progress& progress) {
  const simulation::World world = draw(plan, plan.seed).world;
  simulation::ClosedLoop loop = closed_loop(plan, world, plan.seed);
  require_space(plan.folder, plan.record_bytes());
  const RecordFolder folder(plan.folder, existing_record(options), "--record", plan.input_files());
  plan.folder = folder.path();
  keep_settings(plan);
  std::optional<record::FlightTrace> trace;
  if (plan.trace) trace.emplace(plan.trace_file(), plan.vehicle.rotor_count());
  SimulatedRecorder messages(loop, plan, options.program);
  for (const std::string& assumption : plan.mission.assumptions)
    progress.say(plan.mission.name + ": " + assumption);

  analysis::FlightReport report =
      fly_in_process(loop, plan, plan.seed, flight, trace ? &*trace : nullptr, cancelled, &messages);
  report.warnings = plant::settings_without_effect(world.simulation, world.vehicle, report.simulated_s);
  flight.faults = record::fault_rows(world.simulation);
  report.record_fault = messages.finish(flight.faults);
  if (trace && report.record_fault.empty()) report.record_fault = close(*trace);
  const record::Window window = record::evaluate(flight).window.value_or(record::Window{});
  write_report(plan.folder, flight, report, window, progress);
  return report;
}

}  // namespace swiftlet::ground
