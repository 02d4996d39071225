#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <spawn.h>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "swiftlet/analysis/pages/flight_page.hpp"
#include "swiftlet/analysis/pages/recorded/process_logs.hpp"
#include "swiftlet/analysis/pages/recorded/recorded_flight.hpp"
#include "swiftlet/analysis/report/flight_comparison.hpp"
#include "swiftlet/analysis/report/recorded_flights.hpp"
#include "swiftlet/ground/cli/analysis/log/log_commands.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/record/file/flight_reader.hpp"

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPage = "flight.html";  // in the folder of a record

struct ReportOptions {
  std::vector<std::string> records;
  std::string page;
  bool replace = false;
  bool json = false;
  bool settings = false;
};

void write_page(const std::vector<analysis::RecordedFlight>& recorded, const std::string& page) {
  std::vector<pages::FlightLog> flights;
  for (const analysis::RecordedFlight& one : recorded) {
    const mcap::Reader file(one.file.string());
    flights.push_back(pages::flight_log(file, one.vehicle, one.flown, one.name));
    if (one.file.filename() == record::kFlightFile)
      pages::add_process_logs(fs::absolute(one.file).parent_path(), record::recorded_vehicles(file),
                              flights.back());
  }
  std::string title = flights.size() == 1 ? "Flight" : "Flights";
  for (std::size_t i = 0; i < flights.size(); ++i) title += (i == 0 ? " " : ", ") + flights[i].name;
  const std::string note =
      "Time counts from the start of the mission, without one from take-off. Errors count until it lands.";
  const std::string text = pages::flight_page(title, note, flights);
  io::write_atomically(page, text);
  std::printf("report: wrote %s, %zu %s, %.1f MB\n", page.c_str(), flights.size(),
              flights.size() == 1 ? "flight" : "flights", static_cast<double>(text.size()) / 1e6);
}

// In a browser, if the user sits before a screen.
void show(const std::string& page) {
  if (isatty(STDOUT_FILENO) == 0) return;
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  std::string program = "xdg-open", file = page;
  char* const arguments[] = {program.data(), file.data(), nullptr};
  pid_t opener = 0;  // outlives this process
  ::posix_spawnp(&opener, program.c_str(), nullptr, nullptr, arguments, environ);
}

int report(const ReportOptions& options) {
  std::vector<fs::path> records(options.records.begin(), options.records.end());
  if (records.empty()) records.push_back(analysis::newest_record("flights"));
  std::vector<std::string> files;
  for (const fs::path& record : records) files.push_back(record::flight_file(record).file);
  if (!options.page.empty()) require_new(options.page, options.replace, files);
  std::vector<analysis::RecordedFlight> flights;
  for (const fs::path& record : records) {
    for (analysis::RecordedFlight& flight : analysis::load_record(record))
      flights.push_back(std::move(flight));
  }
  if (!options.page.empty()) {
    write_page(flights, options.page);
    return io::kDone;
  }
  std::string text = options.json ? io::json_text(analysis::comparison_json(flights), 2) + "\n"
                                  : analysis::comparison_table(flights);
  if (options.settings) text += "\n" + analysis::settings_table(flights);
  std::fputs(text.c_str(), stdout);
  if (options.json || records.size() > 1 || !fs::is_directory(records.front())) return io::kDone;
  const std::string page = fs::path(files.front()).parent_path() / kPage;
  write_page(flights, page);
  show(page);
  return io::kDone;
}

}  // namespace

io::Command add_report_command(runtime::CommandLine root) {
  const auto options = std::make_shared<ReportOptions>();
  const runtime::CommandLine app = root.add_subcommand("report", io::purpose_of("report"));
  app.add_option("RECORD", options->records,
                 "records of one or of several vehicles, or MCAP files of recorded messages; default: the "
                 "newest record in "
                 "flights/");
  const auto page = app.add_option("-o,--output", options->page,
                                   "write an HTML page with the paths in space and charts of all signals")
                        .type_name("FILE.html");
  app.add_flag("--replace", options->replace, "overwrite the page").needs(page);
  const auto json = app.add_flag("--json", options->json, "print JSON").excludes(page);
  app.add_flag("--settings", options->settings,
               "also print the control settings; of several records all settings that differ")
      .excludes(page)
      .excludes(json);
  app.footer(
      "Of one record it writes the page into its folder, as flight.html, and opens it where there is a "
      "screen.\n\n"
      "example: swiftlet report flights/20261121-093909-square flights/20261121-093910-square\n"
      "example: swiftlet report hover.mcap -o hover.html");
  return {app, [options] { return report(*options); }};
}

}  // namespace swiftlet::ground
