#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/report/flight_comparison.hpp"
#include "swiftlet/ground/report/recorded_messages.hpp"

namespace swiftlet::ground {
namespace {

struct ReportOptions {
  std::vector<std::string> records;
  bool json = false;
};

int report(const ReportOptions& options) {
  std::vector<std::filesystem::path> records(options.records.begin(), options.records.end());
  if (records.empty()) records.push_back(newest_record("flights"));
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
  const runtime::CommandLine app =
      root.add_subcommand("report", "Report recorded flights, and the settings in which they differ");
  app.add_option("RECORD", options->records,
                 "records of one or of several vehicles, or MCAP files of recorded messages; default: the "
                 "newest record in flights/");
  app.add_flag("--json", options->json, "print JSON");
  app.footer("example: swiftlet report flights/20261121-093909-square flights/20261121-093910-square");
  return {app, [options] { return report(*options); }};
}

}  // namespace swiftlet::ground
