// Evaluates a recorded flight, writes its record and prints its report.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/analysis/report/flight_report.hpp"
#include "swiftlet/io/command_line/progress_line.hpp"
#include "swiftlet/record/evaluation.hpp"

namespace swiftlet::ground {

// Sets duration and tracking errors of the report, and report.completed: true if report.reason is empty, the telemetry is complete
// enough and the peak error is within the tolerance.
void judge(analysis::FlightReport& report, const record::Evaluation& flown);

// What the flight.mcap in a folder holds of a vehicle, also if its end is missing; nullopt if it cannot be read.
std::optional<record::Flight> flight_in(const std::filesystem::path& folder, const std::string& vehicle);

// Writes report.json, flight.gp and flight.png beside flight.mcap. Where a file cannot be written, on a full disk, writes the others and sets
// report.record_fault. Without gnuplot, says in the progress that there is no picture; that is no fault.
void write_report(const std::filesystem::path& folder, const record::Flight& flight,
                  analysis::FlightReport& report, record::Window window, io::Progress& progress);

// Prints the report as JSON to standard output, or as text. Returns the program's exit code: kFailed also for
// a completed flight whose record is incomplete.
int print_report(const analysis::FlightReport& report, bool json, io::ProgressLine& progress);
// Prints the reports of vehicles that flew together. JSON: one object {completed, vehicles: [...]}.
int print_report(const std::vector<analysis::FlightReport>& reports, bool json, io::ProgressLine& progress);

}  // namespace swiftlet::ground
