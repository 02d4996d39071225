#include "swiftlet/ground/flight/recorded_flight.hpp"

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "swiftlet/ground/flight/flight_outcome.hpp"
#include "swiftlet/ground/flight/flight_settings.hpp"
#include "swiftlet/ground/flight/in_process_flight.hpp"
#include "swiftlet/ground/flight/record_folder.hpp"
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

}  // namespace

FlightReport fly_and_record(LaunchConfiguration plan, const FlyOptions& options, FlightRecord& record,
                            const std::function<bool()>& cancelled, Progress& progress) {
  ClosedLoop loop = closed_loop(plan, draw(plan, plan.seed).world, plan.seed);
  require_space(plan.folder, plan.record_bytes());
  const RecordFolder folder(plan.folder, existing_record(options), "--record", plan.input_files());
  plan.folder = folder.path();
  keep_settings(plan);
  std::optional<runtime::FlightTrace> trace;
  if (plan.trace) trace.emplace(plan.trace_file(), plan.vehicle.rotor_count());
  if (plan.sensors) record.sensors = std::make_unique<SensorRecord>(plan.record_capacity());
  loop.sensors = record.sensors.get();
  std::optional<SimulatedRecorder> messages;
  if (plan.mcap) messages.emplace(loop, plan, options.program);
  for (const std::string& assumption : plan.mission.assumptions)
    progress.say(plan.mission.name + ": " + assumption);

  InProcessFlight flight = fly_in_process(loop, plan, plan.seed, record, trace ? &*trace : nullptr, cancelled,
                                          messages ? &*messages : nullptr);
  if (trace) flight.report.record_fault = close(*trace);
  if (messages) {
    const std::string fault = messages->finish();
    if (flight.report.record_fault.empty()) flight.report.record_fault = fault;
  }
  write_record(plan.folder, record, flight.report, flight.window, progress);
  return flight.report;
}

}  // namespace swiftlet::ground
