#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>

#include <fmt/core.h>

#include "swiftlet/analysis/identify/bench_files.hpp"
#include "swiftlet/analysis/identify/identification_report.hpp"
#include "swiftlet/analysis/identify/identify_actions.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/command_line/output_files.hpp"
#include "swiftlet/io/command_line/progress_line.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/format.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/settings/vehicle_writer.hpp"

namespace swiftlet::analysis {
namespace {

namespace fs = std::filesystem;

identification::BenchIdentification identify(const Bench& bench, const std::string& folder,
                                             const plant::Vehicle& base) {
  io::ProgressLine progress;
  const auto started = std::chrono::steady_clock::now();
  try {
    return identification::identify_bench(
        bench.data, base, [&](const std::string& experiment, std::size_t done, std::size_t all) {
          if (std::chrono::steady_clock::now() - started < kProgressAfter) return;
          progress.update(static_cast<int>(done),
                          fmt::format("fitting {}, {} of {}", experiment.c_str(), done + 1, all));
        });
  } catch (const identification::BenchError& fault) {
    const auto file = bench.files.find(fault.experiment());
    if (file == bench.files.end()) throw io::InputError(folder + ": " + fault.what());
    throw io::ConfigError(file->second.file, fault.row() ? file->second.lines[*fault.row()] : 0, "",
                          fault.what());
  }
}

// An invalid name in bench.yaml is reported with its line.
fs::path base_file_of(const std::string& base, const IdentifyBenchOptions& options,
                      const BenchSettings& settings) {
  try {
    return io::configuration_file(io::kinds::kVehicle, base);
  } catch (const std::runtime_error& fault) {
    if (!options.base.empty() || settings.base_vehicle.empty()) throw;
    throw io::ConfigError((fs::path(options.bench) / kBenchSettingsFile).string(), settings.base_vehicle_line,
                          "base_vehicle", fault.what());
  }
}

void refuse_unflyable(const plant::Vehicle& vehicle, const std::string& folder, const std::string& base) {
  for (const plant::Violation& broken : plant::validate(vehicle)) {
    throw io::InputError(folder + ": the identified vehicle cannot fly: " + broken.key + ": " +
                         broken.message + "; are the units and the unmeasured parameters of " + base +
                         " right?");
  }
}

}  // namespace

int identify_bench(const IdentifyBenchOptions& options) {
  const fs::path folder = options.bench;
  IdentificationReport report;
  const BenchSettings settings = load_bench_settings(folder);
  report.bench_folder = options.bench;
  report.base_vehicle = !options.base.empty()            ? options.base
                        : !settings.base_vehicle.empty() ? settings.base_vehicle
                                                         : "kaylion";
  const fs::path base_file = base_file_of(report.base_vehicle, options, settings);
  std::vector<fs::path> inputs = io::files_of(folder);
  inputs.push_back(base_file);
  io::refuse_overwriting({{"--out", options.out}, {"--report", options.report}}, inputs);
  report.base = io::load_vehicle(base_file.string());
  report.bench = load_bench(folder, settings, report.base.esc);
  report.found = identify(report.bench, options.bench, report.base);
  report.found.vehicle.name = !options.name.empty()    ? options.name
                              : !settings.name.empty() ? settings.name
                                                       : fs::path(options.out).stem().string();
  refuse_unflyable(report.found.vehicle, options.bench, report.base_vehicle);

  io::VehicleSources sources = io::load_vehicle_sources(base_file.string());
  for (const auto& [key, source] : report.found.sources) sources[key] = source;
  const std::string comment = "Identified by `swiftlet identify` from the bench " +
                              folder.filename().string() + ";\nunmeasured parameters are those of " +
                              report.base.name + ". Frame: Forward-Right-Down, origin at the centre of mass.";
  const std::string text = io::vehicle_text(report.found.vehicle, sources, report.found.uncertainty, comment);
  io::parse_vehicle(text, options.out);
  if (!options.report.empty()) io::write_atomically(options.report, identification_page(report).html());
  io::write_atomically(options.out, text);

  if (options.json) {
    std::printf("%s\n", identification_json(report).c_str());
  } else {
    std::printf("%s", identification_table(report).c_str());
  }
  std::fprintf(stderr, "swiftlet: %s identified; wrote %s%s\n",
               io::counted(report.found.uncertainty.parameters.size(), "parameter").c_str(),
               options.out.c_str(), options.report.empty() ? "" : (" and " + options.report).c_str());
  return io::kDone;
}

}  // namespace swiftlet::analysis
