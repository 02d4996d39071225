#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/analysis/log/log_commands.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/command_line/programs.hpp"
#include "swiftlet/ground/pages/flight_page.hpp"
#include "swiftlet/ground/pages/recorded/process_logs.hpp"
#include "swiftlet/ground/pages/recorded/recorded_flight.hpp"
#include "swiftlet/ground/report/flight_comparison.hpp"
#include "swiftlet/ground/report/recorded_messages.hpp"
#include "swiftlet/io/atomic_write.hpp"

namespace swiftlet::ground {
namespace {

struct ReportOptions {
  std::vector<std::string> records;
  std::string page;
  bool replace = false;
  bool json = false;
};

constexpr const char* kInRecord = "flight.mcap";  // in the folder of a record

// The MCAP file of a record: the file itself, or the one in its folder.
std::filesystem::path recorded_messages(const std::filesystem::path& record) {
  if (!std::filesystem::is_directory(record)) return record;
  const std::filesystem::path file = record / kInRecord;
  if (!std::filesystem::exists(file))
    throw InputError(record.string() + ": holds no flight.mcap; fly with --mcap for a page of the flight");
  return file;
}

// "20261121-093909-square" of .../20261121-093909-square/flight.mcap, "hover" of hover.mcap.
std::string name_of(const std::filesystem::path& file) {
  const std::filesystem::path whole = std::filesystem::absolute(file);
  return file.filename() == kInRecord ? whole.parent_path().filename() : file.stem();
}

int write_page(const ReportOptions& options, const std::vector<std::filesystem::path>& records) {
  std::vector<pages::FlightLog> flights;
  std::vector<std::string> files;
  for (const std::filesystem::path& record : records) files.push_back(recorded_messages(record));
  require_new(options.page, options.replace, files);
  for (const std::string& file : files) {
    const std::filesystem::path path = std::filesystem::absolute(file);
    for (pages::FlightLog& flight : pages::flights_in(mcap::Reader(file), name_of(file))) {
      if (path.filename() == kInRecord) pages::add_process_logs(path.parent_path(), flight);
      flights.push_back(std::move(flight));
    }
  }
  std::string title = flights.size() == 1 ? "Flight" : "Flights";
  for (std::size_t i = 0; i < flights.size(); ++i) title += (i == 0 ? " " : ", ") + flights[i].name;
  const std::string note = "Time is 0 at take-off. Errors count from take-off to landing.";
  const std::string page = pages::flight_page(title, note, flights);
  runtime::write_atomically(options.page, page);
  std::printf("report: wrote %s, %zu %s, %.1f MB\n", options.page.c_str(), flights.size(),
              flights.size() == 1 ? "flight" : "flights", static_cast<double>(page.size()) / 1e6);
  return kDone;
}

int report(const ReportOptions& options) {
  std::vector<std::filesystem::path> records(options.records.begin(), options.records.end());
  if (records.empty()) records.push_back(newest_record("flights"));
  if (!options.page.empty()) return write_page(options, records);
  std::vector<RecordedFlight> flights;
  for (const std::filesystem::path& record : records) {
    if (std::filesystem::is_regular_file(record)) {
      for (RecordedFlight& flight : load_recorded_messages(record)) flights.push_back(std::move(flight));
      continue;
    }
    for (const std::filesystem::path& flight : flights_of(record))
      flights.push_back(load_recorded_flight(flight));
  }
  const std::string text = options.json ? comparison_json(flights).dump(2) + "\n" : comparison_table(flights);
  std::fputs(text.c_str(), stdout);
  return kDone;
}

}  // namespace

Command add_report_command(runtime::CommandLine root) {
  const auto options = std::make_shared<ReportOptions>();
  const runtime::CommandLine app = root.add_subcommand("report", purpose_of("report"));
  app.add_option("RECORD", options->records,
                 "records of one or of several vehicles, or MCAP files of recorded messages; default: the "
                 "newest record in "
                 "flights/");
  const auto page =
      app.add_option(
             "-o,--output", options->page,
             "write an HTML page with the paths in space and charts of all signals; the records need a "
             "flight.mcap")
          .type_name("FILE.html");
  app.add_flag("--replace", options->replace, "overwrite the page").needs(page);
  app.add_flag("--json", options->json, "print JSON").excludes(page);
  app.footer(
      "example: swiftlet report flights/20261121-093909-square flights/20261121-093910-square\n"
      "example: swiftlet report hover.mcap -o hover.html");
  return {app, [options] { return report(*options); }};
}

}  // namespace swiftlet::ground
