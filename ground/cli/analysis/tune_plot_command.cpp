// `swiftlet tune plot`: the step and frequency responses of control settings, over each other.
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/analysis/tuning/tuning_figure.hpp"
#include "swiftlet/analysis/tuning/tuning_table.hpp"
#include "swiftlet/ground/cli/analysis/tune_commands.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/command_line/output_files.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::ground {
namespace {

struct TunePlotOptions {
  std::vector<std::string> control;
  std::string vehicle = "kaylion";
  std::string output = "tuning.png";
  std::string flight;  // folder of a record
  std::optional<double> delay_s;
  double imu_rate_hz = 500.0;
  bool json = false;
};

// The delay that a flight measured: its sense-to-actuate latency, of which 99 % are below it.
analysis::LoopDelay measured_delay(const std::string& folder) {
  const std::string file = folder + "/report.json";
  const nlohmann::json report = nlohmann::json::parse(io::read_text_file(file), nullptr, false);
  const auto number = [&](const nlohmann::json::json_pointer& key) {
    if (report.is_discarded() || !report.contains(key) || !report.at(key).is_number())
      throw io::InputError(file + ": " + key.to_string() + " is missing; is this the record of a flight?");
    return report.at(key).get<double>();
  };
  const double latency_us = number(nlohmann::json::json_pointer("/sense_to_actuate_us/p99"));
  const double rate_hz = number(nlohmann::json::json_pointer("/imu_rate_hz"));
  if (!(latency_us > 0.0) || !(rate_hz > 0.0))
    throw io::InputError(file +
                         ": no latency was measured; fly in real time, not in lockstep or in one process");
  return {0.5 / rate_hz, 1e-6 * latency_us, folder};
}

analysis::LoopDelay delay_of(const TunePlotOptions& options) {
  if (!options.flight.empty()) return measured_delay(options.flight);
  return {0.5 / options.imu_rate_hz, options.delay_s.value_or(0.0)};
}

std::vector<control::ControlSettings> load_all(const TunePlotOptions& options) {
  std::vector<control::ControlSettings> out;
  for (const std::string& name : options.control) {
    out.push_back(io::load_control_settings(io::configuration_file(io::kinds::kControl, name)));
    for (std::size_t i = 0; i + 1 < out.size(); ++i)
      if (out[i].name == out.back().name) out.back().name += " (" + name + ")";
  }
  return out;
}

int plot_tuning(const TunePlotOptions& options) {
  const std::filesystem::path vehicle_file = io::configuration_file(io::kinds::kVehicle, options.vehicle);
  std::vector<std::filesystem::path> inputs = {vehicle_file};
  for (const std::string& name : options.control)
    inputs.push_back(io::configuration_file(io::kinds::kControl, name));
  io::refuse_overwriting({{"--out", options.output}}, inputs);
  const plant::Vehicle vehicle = io::load_vehicle(vehicle_file);
  const analysis::TuningStudy study = analysis::study_tuning(vehicle, load_all(options), delay_of(options));
  std::printf("%s",
              (options.json ? analysis::tuning_json(study) + "\n" : analysis::tuning_table(study)).c_str());
  const std::string fault = analysis::draw_tuning(options.output, study);
  if (!fault.empty()) {
    std::fprintf(stderr, "swiftlet: tune plot: %s\n", fault.c_str());
    return io::kFailed;
  }
  std::fprintf(stderr, "wrote %s\n", options.output.c_str());
  return io::kDone;
}

}  // namespace

io::Command add_tune_plot_command(runtime::CommandLine tune) {
  const auto options = std::make_shared<TunePlotOptions>();
  const runtime::CommandLine app = tune.add_subcommand(
      "plot", "Draw step responses and Bode diagrams of control settings over each other");
  app.footer(
      "The loops include rotor lag, observers and delay; their margins are printed (docs/tuning.md).\n\n"
      "example: swiftlet tune plot motor_lag mine.yaml --flight flights/A -o tuning.png");
  app.add_option("control", options->control,
                 "control settings files, or the names of such in config/control")
      .type_name(io::kinds::kControl.value)
      .required();
  app.add_option("--vehicle", options->vehicle, "vehicle file, or the name of one in config/vehicles")
      .type_name(io::kinds::kVehicle.value)
      .show_default();
  app.add_option("-o,--out", options->output, "output file, PNG").show_default();
  app.add_option(
      "--flight", options->flight,
      "record of a flight in real time: its measured sense-to-actuate latency (99 %) is the delay");
  app.add_option(
         "--delay", options->delay_s,
         "delay from sample to rotors in s, in place of --flight; as `swiftlet identify flight` prints it")
      .range(0.0, 0.1)
      .excludes(app.option("--flight"));
  app.add_option("--imu-rate", options->imu_rate_hz, "rate of the IMU, Hz; half its period adds to the delay")
      .range(50.0, 10000.0)
      .show_default()
      .excludes(app.option("--flight"));
  app.add_flag("--json", options->json, "print JSON");
  return {app, [options] { return plot_tuning(*options); }};
}

}  // namespace swiftlet::ground
