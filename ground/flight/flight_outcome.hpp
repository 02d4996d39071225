// What every recorded flight ends with, whichever way it was flown.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "swiftlet/ground/report/flight_report.hpp"
#include "swiftlet/ground/terminal/progress_line.hpp"
#include "swiftlet/recording/flight_record.hpp"

namespace swiftlet::ground {

// Throws InputError if the folder cannot be made; option is the one that names it.
void make_record_folder(const std::filesystem::path& folder, const std::string& option = "--record");

// Takes the errors inside the window, and decides whether the flight counts as completed: no reason against
// it in the report, enough telemetry to judge it by, and the errors within the tolerance.
void evaluate(FlightReport& report, const FlightRecord& record, Window window);

// Writes flight.csv, report.json, flight.gp and flight.png. Throws std::runtime_error for what cannot be
// written; a picture that cannot be drawn is a line of progress only.
void write_record(const std::filesystem::path& folder, const FlightRecord& record, const FlightReport& report,
                  Window window, Progress& progress);

// The report, as JSON on standard output or as text. Returns what the program is to return.
int print_report(const FlightReport& report, bool json, ProgressLine& progress);
// Those of vehicles that flew together: as JSON one object, {completed, vehicles: [...]}.
int print_report(const std::vector<FlightReport>& reports, bool json, ProgressLine& progress);

}  // namespace swiftlet::ground
