// Evaluates a recorded flight, writes its record and prints its report.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "swiftlet/ground/report/flight_report.hpp"
#include "swiftlet/ground/terminal/progress_line.hpp"
#include "swiftlet/recording/flight_record.hpp"

namespace swiftlet::ground {

// Computes the tracking errors inside the window and sets report.completed: true if report.reason is empty,
// the telemetry is complete enough and the peak error is within the tolerance.
void evaluate(FlightReport& report, const FlightRecord& record, Window window);

// Writes report.json, flight.csv, sensors.csv, flight.gp and flight.png. Where a file cannot be written, on a
// full disk, writes the others, sets report.record_fault, and leaves an unfinished CSV file as NAME.part.
// Without gnuplot, says in the progress that there is no picture; that is no fault.
void write_record(const std::filesystem::path& folder, const FlightRecord& record, FlightReport& report,
                  Window window, Progress& progress);

// Prints the report as JSON to standard output, or as text. Returns the program's exit code: kFailed also for
// a completed flight whose record is incomplete.
int print_report(const FlightReport& report, bool json, ProgressLine& progress);
// Prints the reports of vehicles that flew together. JSON: one object {completed, vehicles: [...]}.
int print_report(const std::vector<FlightReport>& reports, bool json, ProgressLine& progress);

}  // namespace swiftlet::ground
