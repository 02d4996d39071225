// `swiftlet tune delay`: control settings for a loop with a delay.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/core.h>

#include "swiftlet/analysis/tuning/delay_design.hpp"
#include "swiftlet/control/design/flown_loops.hpp"
#include "swiftlet/ground/cli/analysis/level_gains.hpp"
#include "swiftlet/ground/cli/analysis/tune_commands.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/command_line/output_files.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/edit_yaml.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::ground {
namespace {

// A standby waits at most 0.25 s for the command of a controller that flies, and would take over at longer delays.
constexpr double kLongestTunedDelay_s = 0.2;

struct TuneDelayOptions {
  double delay_s = 0.0;
  std::string control = "motor_lag";
  std::string vehicle = "kaylion";
  plant::ControlLevel level = plant::ControlLevel::kActuators;
  std::string output = "slow.yaml";
};

std::string table(const analysis::DelayDesign& design, double delay_s) {
  std::string text = fmt::format("for a delay of {:.0f} ms: {:.0f} % of the bandwidth of every loop\n",
                                 1e3 * delay_s, 100.0 * design.factor);
  text += "tolerated delay, ms:";
  for (std::size_t i = 0; i < design.margins_s.size(); ++i)
    text += std::isfinite(design.margins_s[i])
                ? fmt::format("  {} {:.0f}", control::kFlownLoopNames[i], 1e3 * design.margins_s[i])
                : fmt::format("  {} any", control::kFlownLoopNames[i]);
  return text + "\n";
}

int design_delay(const TuneDelayOptions& options) {
  const std::filesystem::path vehicle_file = io::configuration_file(io::kinds::kVehicle, options.vehicle);
  const std::filesystem::path control_file = io::configuration_file(io::kinds::kControl, options.control);
  io::refuse_overwriting({{"--out", options.output}}, {vehicle_file, control_file});
  if (options.level == plant::ControlLevel::kTrajectory)
    throw io::InputError("--level trajectory: the vehicle closes all loops, control none");
  const std::string text = io::read_text_file(control_file);
  analysis::DelayDesign design;
  try {
    const plant::Vehicle vehicle = io::load_vehicle(vehicle_file);
    design = analysis::design_for_delay(vehicle, io::parse_control_settings(text, control_file),
                                        options.delay_s, {options.level, vehicle_loops(vehicle)});
  } catch (const std::invalid_argument& e) {
    throw io::InputError(e.what());
  }
  design.settings.name = std::filesystem::path(options.output).stem();
  const std::string slowed_text =
      io::with_scalars(text, control_file, analysis::slowed_values(design.settings));
  // Refuses a name that is none.
  const control::ControlSettings written = io::parse_control_settings(slowed_text, options.output);
  if (analysis::slowed_values(written) != analysis::slowed_values(design.settings))
    throw io::InputError(control_file.string() +
                         ": its values cannot be replaced in place; write each on a line of its own");
  io::write_atomically(options.output, slowed_text);
  std::printf("%s", table(design, options.delay_s).c_str());
  std::fprintf(stderr, "wrote %s\n", options.output.c_str());
  return io::kDone;
}

}  // namespace

io::Command add_tune_delay_command(runtime::CommandLine tune) {
  const auto options = std::make_shared<TuneDelayOptions>();
  const runtime::CommandLine app =
      tune.add_subcommand("delay", "Make slower gains that tolerate a delay of the loop");
  app.footer(
      "Slows all loops down by one factor, until each tolerates twice the delay (docs/lossy-networks.md).\n"
      "`swiftlet status` shows the measured delay.\n\n"
      "example: swiftlet tune delay 0.04 --out slow.yaml");
  app.add_option("delay", options->delay_s,
                 "delay from an IMU sample to the rotors, s; both ways of the network")
      .range(0.001, kLongestTunedDelay_s)
      .required();
  app.add_option("--control", options->control,
                 "control settings file, or the name of one in config/control, to begin with")
      .type_name(io::kinds::kControl.value)
      .show_default();
  app.add_option("--vehicle", options->vehicle, "vehicle file, or the name of one in config/vehicles")
      .type_name(io::kinds::kVehicle.value)
      .show_default();
  add_level_option(app, options->level);
  app.add_option("-o,--out", options->output, "output file; the settings are named after it").show_default();
  return {app, [options] { return design_delay(*options); }};
}

}  // namespace swiftlet::ground
