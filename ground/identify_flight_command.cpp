#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "ground/commands.hpp"
#include "ground/flight_identification_report.hpp"
#include "ground/flight_log_files.hpp"
#include "ground/format.hpp"
#include "ground/installation.hpp"
#include "ground/numbers.hpp"
#include "ground/output_files.hpp"
#include "ground/progress_line.hpp"
#include "ground/whole_file.hpp"
#include "services/runtime/vehicle_file.hpp"
#include "services/runtime/vehicle_writer.hpp"

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kQuickEnough{500};  // without progress

struct IdentifyFlightOptions {
  std::vector<std::string> logs;
  std::string base;
  std::string out;
  std::string report;
  std::string name;
  identification::FlightOptions fit;
  BodyAxes axes = BodyAxes::kAsSaid;
  bool json = false;
};

struct Base {
  fs::path file;
  bool assumed;  // neither named nor that of a record
};

// By --base, or from the record that the log is part of.
Base base_of(const IdentifyFlightOptions& options) {
  if (!options.base.empty()) return {configuration_file("vehicles", options.base), false};
  const fs::path log = options.logs.front();
  const fs::path kept = (fs::is_directory(log) ? log : log.parent_path()) / "vehicle.yaml";
  if (fs::is_regular_file(kept)) return {kept, false};
  return {configuration_file("vehicles", "kaylion"), true};
}

int run_identify_flight(IdentifyFlightOptions options) {
  std::vector<fs::path> inputs;
  for (const std::string& log : options.logs) {
    for (const fs::path& file : files_of(log)) inputs.push_back(file);
  }
  const auto [base_path, is_assumed] = base_of(options);
  inputs.push_back(base_path);
  refuse_overwriting({{"--out", options.out}, {"--report", options.report}}, inputs);
  const plant::Vehicle base = runtime::load_vehicle(base_path.string());
  FlightIdentificationReport report;
  report.logs = options.logs;
  report.base_vehicle = options.base.empty() ? base_path.string() : options.base;
  if (is_assumed)
    report.assumptions.push_back("the vehicle is taken to be like " + base.name +
                                 ", there being no --base and no record around the log");

  ProgressLine progress;
  const auto started = std::chrono::steady_clock::now();
  int iterations = 0;
  options.fit.progress = [&](const std::string& what) {
    ++iterations;
    if (std::chrono::steady_clock::now() - started > kQuickEnough)
      progress.update(0, format("%s, iteration %d", what.c_str(), iterations));
  };
  std::vector<identification::FlightLog> logs;
  for (const std::string& file : options.logs) {
    ReadFlightLog read = read_flight_log(file, base, options.axes);
    for (const std::string& assumption : read.assumptions)
      report.assumptions.push_back(options.logs.size() > 1 ? file + ": " + assumption : assumption);
    logs.push_back(std::move(read.log));
  }
  try {
    report.found = identification::identify_flight(logs, base, options.fit);
  } catch (const identification::BadData& fault) {
    throw InputError(fault.what());
  }
  progress.close();
  plant::Vehicle& vehicle = report.found.vehicle;
  if (!options.out.empty())
    vehicle.name = options.name.empty() ? fs::path(options.out).stem().string() : options.name;

  if (options.json) {
    std::printf("%s\n", flight_identification_json(report).c_str());
  } else {
    std::printf("%s", flight_identification_table(report).c_str());
  }
  if (!options.report.empty()) write_whole_file(options.report, flight_identification_html(report));
  if (!report.found.converged)
    throw std::runtime_error(options.out.empty()
                                 ? "the fit is not to be trusted"
                                 : "the fit is not to be trusted: " + options.out + " is not written");
  if (!options.out.empty()) {
    if (report.found.uncertainty.parameters.empty())
      throw std::runtime_error("nothing of the vehicle was told, see above: " + options.out +
                               " is not written");
    for (const plant::Violation& broken : plant::validate(vehicle)) {
      throw InputError("the identified vehicle cannot fly: " + broken.key + ": " + broken.message +
                       "; what no flight tells is from " + report.base_vehicle);
    }
    runtime::VehicleSources sources = runtime::load_vehicle_sources(base_path.string());
    for (const auto& [key, source] : report.found.sources) sources[key] = source;
    const std::string text = runtime::vehicle_text(
        vehicle, sources, report.found.uncertainty,
        "Identified by `swiftlet identify flight`; what flights did not tell is from the vehicle " +
            base.name + ". Frame: Forward-Right-Down, origin at the centre of mass.");
    runtime::parse_vehicle(text, options.out);
    write_whole_file(options.out, text);
  }
  std::string wrote;
  for (const std::string& file : {options.out, options.report}) {
    if (!file.empty()) wrote += (wrote.empty() ? "; wrote " : " and ") + file;
  }
  std::fprintf(stderr, "swiftlet: %s of the vehicle told by %s%s\n",
               counted(report.found.uncertainty.parameters.size(), "parameter").c_str(),
               counted(logs.size(), "flight").c_str(), wrote.c_str());
  return kDone;
}

}  // namespace

Command add_identify_flight_command(CLI::App& identify) {
  const auto options = std::make_shared<IdentifyFlightOptions>();
  CLI::App* const app = identify.add_subcommand("flight", "Identify a vehicle from logs of its flights");
  app->add_option("logs", options->logs,
                  "records of `swiftlet fly --sensors`, or CSV files, gzip or not, of one vehicle")
      ->required()
      ->type_name("LOG...");
  app->add_option("--base", options->base,
                  "vehicle file, or the name of one in the configuration, for all that flights do not tell; "
                  "the record's "
                  "vehicle, else kaylion, unless given")
      ->type_name("VEHICLE");
  app->add_option("--known", options->fit.known,
                  "a flight tells thrust over mass alone: which of them the base vehicle has right")
      ->transform(CLI::CheckedTransformer(
                      std::map<std::string, identification::Known>{
                          {"mass", identification::Known::kMass}, {"thrust", identification::Known::kThrust}})
                      .description("{mass,thrust}"))
      ->default_str("mass");
  app->add_option("--axes", options->axes,
                  "body axes of the IMU, where the names of the columns do not say them: frd or flu")
      ->transform(CLI::CheckedTransformer(
                      std::map<std::string, BodyAxes>{{"frd", BodyAxes::kFrd}, {"flu", BodyAxes::kFlu}})
                      .description("{frd,flu}"));
  app->add_option("--from", options->fit.bounds.from_s,
                  "time by the log at which the flight begins, s; found unless given")
      ->check(finite_number());
  app->add_option("--until", options->fit.bounds.until_s,
                  "time by the log at which it ends, s; found unless given")
      ->check(finite_number());
  app->add_option("--out", options->out, "the vehicle file to write")->type_name("FILE");
  app->add_option("--report", options->report, "a page with estimates and predictions; one HTML file")
      ->type_name("FILE");
  app->add_option("--name", options->name, "name of the vehicle; that of --out unless given");
  app->add_flag("--json", options->json, "print one JSON object instead of the table");
  app->footer(
      "Columns of a log, each headed `name [unit]`: time; specific_force_x, body_rate_x, likewise y and z; "
      "throttle1, or "
      "pulse_width1, for each\nmotor in the order of the vehicle's rotors. If there: supply_voltage; "
      "pose_time with position_x_ned and "
      "orientation_w_ned_from_frd and so on;\nrunning; rotor_speed1 and so on. What a log without poses or "
      "voltage tells is less (docs/identification.md).\n\n"
      "example: swiftlet sim fly identification --sensors --record first && swiftlet identify flight first "
      "--out mine.yaml\n"
      "         swiftlet identify flight tests/data/crazyflie_flight.csv.gz --base crazyflie2");
  return {app, [options] { return run_identify_flight(*options); }};
}

}  // namespace swiftlet::ground
