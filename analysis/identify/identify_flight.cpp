#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/analysis/identify/flight_identification_report.hpp"
#include "swiftlet/analysis/identify/identify_actions.hpp"
#include "swiftlet/analysis/identify/identify_ulog.hpp"
#include "swiftlet/analysis/logs/flight_log_files.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/command_line/output_files.hpp"
#include "swiftlet/io/command_line/progress_line.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/format.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/settings/vehicle_writer.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/record/file/flight_reader.hpp"
#include "swiftlet/record/mcap/attached_file.hpp"

namespace swiftlet::analysis {
namespace {

namespace fs = std::filesystem;

// A vehicle file.
struct Base {
  std::string name;  // as it is said
  std::string text;
  fs::path file;  // empty: of a recording
};

// --base, else what the recording holds, else vehicle.yaml beside the log. Throws InputError without any.
Base base_of(const IdentifyFlightOptions& options) {
  const auto read = [&](const fs::path& file, const std::string& name) {
    return Base{name, io::read_text_file(file.string()), file};
  };
  if (!options.base.empty())
    return read(io::configuration_file(io::kinds::kVehicle, options.base), options.base);
  const fs::path log = options.logs.front();
  if (fs::is_directory(log) || record::is_mcap(log)) {
    const record::FlightFile from = record::flight_file(log);
    const mcap::Reader file(from.file.string());
    const std::string vehicle =
        record::recorded_vehicle(file, from.vehicle.empty() ? options.vehicle : from.vehicle);
    if (const auto text = mcap::attached_file(file, vehicle, "vehicle.yaml"))
      return {log.string() + "/vehicle.yaml", *text, {}};
  }
  const fs::path beside = (fs::is_directory(log) ? log : log.parent_path()) / "vehicle.yaml";
  if (fs::is_regular_file(beside)) return read(beside, beside.string());
  throw io::InputError("--base: is needed: " + log.string() +
                       " does not hold the vehicle file that was flown with");
}

// Reads the logs and fits the vehicle to them.
void fit(IdentifyFlightOptions& options, const plant::Vehicle& base, FlightIdentificationReport& report) {
  io::ProgressLine progress;
  const auto started = std::chrono::steady_clock::now();
  int iterations = 0;
  options.fit.progress = [&](const std::string& what) {
    ++iterations;
    if (std::chrono::steady_clock::now() - started > kProgressAfter)
      progress.update(0, fmt::format("{}, iteration {}", what.c_str(), iterations));
  };
  std::vector<identification::FlightLog> logs;
  for (const std::string& file : options.logs) {
    ReadFlightLog read = read_flight_log(file, base, options.axes, options.vehicle);
    for (const std::string& assumption : read.assumptions)
      report.assumptions.push_back(options.logs.size() > 1 ? file + ": " + assumption : assumption);
    logs.push_back(std::move(read.log));
  }
  try {
    report.found = identification::identify_flight(logs, base, options.fit);
  } catch (const identification::BadData& fault) {
    throw io::InputError(fault.what());
  }
  progress.close();
}

// Throws if the vehicle is not good enough for a file.
void write_vehicle(const std::string& out, const Base& base, const std::string& base_name,
                   const FlightIdentificationReport& report) {
  const identification::FlightIdentification& found = report.found;
  if (found.uncertainty.parameters.empty())
    throw std::runtime_error("no parameter is identifiable, see above: " + out + " is not written");
  for (const plant::Violation& broken : plant::validate(found.vehicle)) {
    throw io::InputError("the identified vehicle cannot fly: " + broken.key + ": " + broken.message +
                         "; parameters that are not identified are those of " + report.base_vehicle);
  }
  io::VehicleSources sources = io::parse_vehicle_sources(base.text, base.name);
  for (const auto& [key, source] : found.sources) sources[key] = source;
  const std::string text = io::vehicle_text(
      found.vehicle, sources, found.uncertainty,
      "Identified by `swiftlet identify flight`; parameters that were not identified are those of " +
          base_name + ". Frame: Forward-Right-Down, origin at the centre of mass.");
  io::parse_vehicle(text, out);
  io::write_atomically(out, text);
}

void say_what_was_done(const IdentifyFlightOptions& options, const FlightIdentificationReport& report) {
  std::string wrote;
  for (const std::string& file : {options.out, options.report}) {
    if (!file.empty()) wrote += (wrote.empty() ? "; wrote " : " and ") + file;
  }
  std::fprintf(stderr, "swiftlet: %s identified from %s%s\n",
               io::counted(report.found.uncertainty.parameters.size(), "parameter").c_str(),
               io::counted(options.logs.size(), "flight").c_str(), wrote.c_str());
}

}  // namespace

int identify_flight(IdentifyFlightOptions options) {
  std::vector<fs::path> inputs;
  for (const std::string& log : options.logs) {
    for (const fs::path& file : io::files_of(log)) inputs.push_back(file);
  }
  const Base from = base_of(options);
  const plant::Vehicle base = io::parse_vehicle(from.text, from.name);
  if (is_ulog(options.logs.front())) return identify_ulog(options, base, from.file.stem().string());
  if (!from.file.empty()) inputs.push_back(from.file);
  io::refuse_overwriting({{"--out", options.out}, {"--report", options.report}}, inputs);
  FlightIdentificationReport report;
  report.logs = options.logs;
  report.base_vehicle = from.name;
  fit(options, base, report);
  if (!options.out.empty())
    report.found.vehicle.name = options.name.empty() ? fs::path(options.out).stem().string() : options.name;

  if (options.json) {
    std::printf("%s\n", flight_identification_json(report).c_str());
  } else {
    std::printf("%s", flight_identification_table(report).c_str());
  }
  if (!options.report.empty())
    io::write_atomically(options.report, flight_identification_page(report).html());
  if (!report.found.converged)
    throw std::runtime_error(options.out.empty() ? "the fit did not converge within its bounds"
                                                 : "the fit did not converge within its bounds: " +
                                                       options.out + " is not written");
  if (!options.out.empty()) write_vehicle(options.out, from, base.name, report);
  say_what_was_done(options, report);
  return io::kDone;
}

}  // namespace swiftlet::analysis
