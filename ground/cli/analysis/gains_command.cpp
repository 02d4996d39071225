#include "swiftlet/ground/cli/analysis/gains_command.hpp"

#include <cstdio>
#include <memory>

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/design/flown_delay.hpp"
#include "swiftlet/ground/batch/gains_report.hpp"
#include "swiftlet/ground/cli/analysis/level_gains.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"

namespace swiftlet::ground {

int run_gains(const GainsOptions& options) {
  const std::string file = io::configuration_file(io::kinds::kVehicle, options.vehicle).string();
  const plant::Vehicle vehicle = io::load_vehicle(file);
  const control::ControlSettings settings =
      io::load_control_settings(io::configuration_file(io::kinds::kControl, options.control));
  if (options.level.value_or(plant::ControlLevel::kActuators) != plant::ControlLevel::kActuators) {
    const LevelGains gains = level_gains(vehicle, settings, *options.level, options.delay_s);
    std::printf("%s%s", options.json ? level_gains_json(gains).c_str() : level_gains_table(gains).c_str(),
                options.json ? "\n" : "");
    return io::kDone;
  }
  const control::ControlDesign design = control::design(vehicle, settings);
  for (const plant::Violation& loop : control::unstable_loops(design)) {
    std::fprintf(stderr, "swiftlet: not flyable: %s: %s\n", loop.key.c_str(), loop.message.c_str());
  }
  const plant::VehicleUncertainty uncertainty = io::load_vehicle_uncertainty(file);
  const simulation::Dispersion dispersion = uncertainty.parameters.empty()
                                                ? simulation::Dispersion{}
                                                : simulation::dispersion_of(uncertainty, vehicle, file);
  const MarginStudy margins = study_margins(design, vehicle, dispersion, options.samples, options.seed);
  const FlownDelays flown_delay_s = control::flown_delay_margins(design, settings);
  if (options.json) {
    std::printf("%s\n", gains_json(design, margins, flown_delay_s, vehicle.name, settings.name).c_str());
  } else {
    std::printf("%s", gains_table(design, margins, flown_delay_s, vehicle.name, settings.name).c_str());
  }
  return io::kDone;
}

io::Command add_gains_command(runtime::CommandLine root) {
  const auto options = std::make_shared<GainsOptions>();
  const runtime::CommandLine app = root.add_subcommand("gains", io::purpose_of("gains"));
  app.footer(
      "example: swiftlet gains --vehicle config/vehicles/kaylion.yaml --json\nexample: swiftlet gains "
      "--vehicle crazyflie2 --level attitude --delay 0.04");
  app.add_option("--vehicle", options->vehicle, "vehicle file, or the name of one in config/vehicles")
      .type_name(io::kinds::kVehicle.value)
      .show_default();
  app.add_option("--control", options->control, "control settings file, or the name of one in config/control")
      .type_name(io::kinds::kControl.value)
      .show_default();
  app.add_option("--samples", options->samples,
                 "number of vehicles sampled from the uncertainty in the vehicle file, for the margins")
      .range(std::size_t{1}, std::size_t{1'000'000})
      .show_default();
  app.add_option("--seed", options->seed, "random seed of the first sample; each further sample adds one")
      .whole()
      .show_default();
  using plant::ControlLevel;
  const runtime::Option level = app.add_choice<std::optional<ControlLevel>>(
      "--level", options->level,
      {{"actuators", ControlLevel::kActuators},
       {"rates", ControlLevel::kRates},
       {"attitude", ControlLevel::kAttitude},
       {"trajectory", ControlLevel::kTrajectory}},
      "print the loops of a vehicle that is commanded at this level and closes the inner ones itself, as "
      "the simulated firmware does");
  app.add_option("--delay", options->delay_s,
                 "with --level: delay from an IMU sample to the vehicle that obeys the command, s; both ways "
                 "of the radio")
      .range(0.0, 0.5)
      .needs(level);
  app.add_flag("--json", options->json, "print JSON");
  return {app, [options] { return run_gains(*options); }};
}

}  // namespace swiftlet::ground
