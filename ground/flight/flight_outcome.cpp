#include "swiftlet/ground/flight/flight_outcome.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/analysis/report/flight_files.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/record/file/flight_reader.hpp"

namespace swiftlet::ground {
namespace {

// Why a mission that was flown to its end does not count as completed; empty if it counts.
std::string shortfall(const analysis::FlightReport& report, record::Window window) {
  if (report.errors.matched == 0 && !report.record_fault.empty())
    return "nothing was recorded by which it could be judged: " + report.record_fault;
  if (!record::enough_samples(report.errors, window)) {
    return fmt::format(
        "too little telemetry: {0} of {1:.0f} samples matched (at least {3:.0f} %), longest gap {2:.2f} s "
        "(at most {4:.2f} s)",
        report.errors.matched, window.duration_s() * record::kTelemetryRateHz, report.errors.longest_gap_s,
        record::kLeastMatchedFraction * 100.0, record::kLongestGapS);
  }
  if (!std::isfinite(report.errors.rms_3d_m))
    return std::string("the ") + record::to_string(report.errors.against) + " is not finite";
  if (report.errors.peak_3d_m > report.tolerance_m) {
    return fmt::format("the peak tracking error was {:.3f} m, the tolerance is {:.3f} m",
                       report.errors.peak_3d_m, report.tolerance_m);
  }
  return {};
}

void say_record_fault(const analysis::FlightReport& report, io::Progress& progress) {
  if (!report.record_fault.empty())
    progress.say("swiftlet: the record " + report.record_dir + " is incomplete: " + report.record_fault);
}

}  // namespace

void judge(analysis::FlightReport& report, const record::Evaluation& flown) {
  report.duration_s = flown.duration_s;
  report.errors = flown.errors;
  if (report.reason.empty()) report.reason = shortfall(report, flown.window.value_or(record::Window{}));
  report.completed = report.reason.empty();
}

std::optional<record::Flight> flight_in(const std::filesystem::path& folder, const std::string& vehicle) {
  try {
    return record::read_flight(mcap::Reader((folder / record::kFlightFile).string()), vehicle);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

void write_report(const std::filesystem::path& folder, const record::Flight& flight,
                  analysis::FlightReport& report, record::Window window, io::Progress& progress) {
  const auto attempt = [&](const std::filesystem::path& file, const auto& write) {
    try {
      write(file);
    } catch (const std::exception& fault) {
      if (report.record_fault.empty()) report.record_fault = fault.what();
    }
  };
  // First the smallest file, with the result. It is written again at the end if another one has failed.
  attempt(folder / "report.json", [&](const auto& file) { analysis::write_report_json(file, report); });
  if (report.errors.matched > 0) {
    attempt(folder / "flight.png", [&](const auto&) {
      const std::string no_picture = analysis::draw_flight(folder, flight, report, window);
      if (!no_picture.empty()) progress.say(no_picture);
    });
  }
  if (!report.record_fault.empty())
    attempt(folder / "report.json", [&](const auto& file) { analysis::write_report_json(file, report); });
}

int print_report(const analysis::FlightReport& report, bool json, io::ProgressLine& progress) {
  progress.close();
  if (json) {
    std::printf("%s\n", io::json_text(to_json(report)).c_str());
    if (!report.completed) progress.say("swiftlet: " + report.reason);
  } else {
    std::fputs(to_text(report).c_str(), report.completed ? stdout : stderr);
  }
  say_record_fault(report, progress);
  return report.completed && report.record_fault.empty() ? io::kDone : io::kFailed;
}

int print_report(const std::vector<analysis::FlightReport>& reports, bool json, io::ProgressLine& progress) {
  progress.close();
  const auto completed = static_cast<std::size_t>(std::count_if(
      reports.begin(), reports.end(), [](const analysis::FlightReport& report) { return report.completed; }));
  const bool all = completed == reports.size();
  if (json) {
    nlohmann::ordered_json whole = {{"completed", all}, {"vehicles", nlohmann::ordered_json::array()}};
    for (const analysis::FlightReport& report : reports) whole["vehicles"].push_back(to_json(report));
    std::printf("%s\n", io::json_text(whole).c_str());
  }
  for (const analysis::FlightReport& report : reports) {
    if (!json) {
      const std::string text = report.vehicle_name + ", " + to_text(report);
      std::fputs(text.c_str(), report.completed ? stdout : stderr);
    } else if (!report.completed) {
      progress.say("swiftlet: " + report.vehicle_name + ": " + report.reason);
    }
    say_record_fault(report, progress);
  }
  if (!json) std::printf("%zu of %zu flights completed\n", completed, reports.size());
  const bool recorded = std::all_of(reports.begin(), reports.end(), [](const analysis::FlightReport& report) {
    return report.record_fault.empty();
  });
  return all && recorded ? io::kDone : io::kFailed;
}

}  // namespace swiftlet::ground
