// Writes the files of a flight record: flight.csv, report.json, flight.gp and flight.png.
#pragma once

#include <filesystem>
#include <string>

#include "swiftlet/ground/report/flight_report.hpp"
#include "swiftlet/recording/flight_record.hpp"

namespace swiftlet::ground {

// Writes one row for each ground truth sample that has a reference of the same stamp, with the estimate of
// that stamp if there is one. Without references, writes a row about every 15 ms, with empty cells. The time
// t is 0 at the start of the window. The header names frame and unit of each column; docs/csv.md describes
// them. With a record of the sensors, also the throttles of the commands. Throws std::runtime_error if the file
// cannot be written.
void write_flight_csv(const std::filesystem::path& file, const FlightRecord& record, Window window);

void write_report_json(const std::filesystem::path& file, const FlightReport& report);

// Draws folder/flight.png, and writes the gnuplot script folder/flight.gp to draw it again. Returns an empty
// string, or a sentence if gnuplot is not installed. Throws std::runtime_error if the picture could not be
// drawn or written whole; there is none then.
std::string draw_flight(const std::filesystem::path& folder, const FlightRecord& record,
                        const FlightReport& report, Window window);

}  // namespace swiftlet::ground
