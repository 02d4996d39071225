#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/report/flight_comparison.hpp"

namespace swiftlet::ground {
namespace {

struct ReportOptions {
  std::vector<std::string> folders;
  bool json = false;
};

int report(const ReportOptions& options) {
  std::vector<RecordedFlight> flights;
  for (const std::string& folder : options.folders) flights.push_back(load_recorded_flight(folder));
  if (flights.empty()) flights.push_back(load_recorded_flight(newest_flight("flights")));
  const std::string text = options.json ? comparison_json(flights).dump(2) + "\n" : comparison_table(flights);
  std::fputs(text.c_str(), stdout);
  return kDone;
}

}  // namespace

Command add_report_command(runtime::CommandLine root) {
  const auto options = std::make_shared<ReportOptions>();
  const runtime::CommandLine app =
      root.add_subcommand("report", "Report recorded flights, and the settings in which they differ");
  app.add_option("FOLDER", options->folders, "flight records; default: the newest one in flights/");
  app.add_flag("--json", options->json, "print JSON");
  app.footer("example: swiftlet report flights/20261121-093909-square flights/20261121-093910-square");
  return {app, [options] { return report(*options); }};
}

}  // namespace swiftlet::ground
