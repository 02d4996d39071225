#include <memory>
#include <string>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/ground/flight/flight_outcome.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/ground/flight/recorded_flight.hpp"

namespace swiftlet::ground {
namespace {

int sim_fly(const FlyOptions& options) {
  const LaunchConfiguration plan = plan_flight(options);
  io::ProgressLine progress;
  const Interrupts interrupts;
  record::Flight flight;
  const analysis::FlightReport report = fly_and_record(
      plan, options, flight, [&] { return interrupts.count() > 0; }, progress);
  return print_report(report, options.json, progress);
}

}  // namespace

io::Command add_sim_fly_command(runtime::CommandLine sim, const std::string& version) {
  const auto options = std::make_shared<FlyOptions>();
  options->program = version;
  options->launch_mode = LaunchMode::kInProcess;
  const runtime::CommandLine app =
      sim.add_subcommand("fly", "Fly a mission in one process, as fast as possible");
  add_fly_options(app, *options);
  add_dispersion_option(app, *options);
  app.add_flag("--trace", options->trace,
               "write trace.csv, which holds every sample and command bit for bit, to compare flights");
  app.footer(
      "The flight equals that of `swiftlet fly --clock lockstep` with the same files and seed.\n\n"
      "example: swiftlet sim fly square --seed 7 --json | jq .rms_3d_m");
  return {app, [options] { return sim_fly(*options); }};
}

}  // namespace swiftlet::ground
