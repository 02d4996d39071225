// The files that a recorded flight leaves in its folder: flight.csv, report.json, flight.gp and flight.png.
#pragma once

#include <filesystem>
#include <string>

#include "swiftlet/ground/report/flight_report.hpp"
#include "swiftlet/recording/flight_record.hpp"

namespace swiftlet::ground {

// One row for each ground truth with a reference of the same stamp, and estimate if there is one; t = 0 at
// the window's start. Where references stay away, a row now and then with empty cells. Columns: t, mode,
// position, velocity, attitude, body rates, then ref_, est_, v_s and rotor speeds, SI units. Throws
// std::runtime_error if the file cannot be written.
void write_flight_csv(const std::filesystem::path& file, const FlightRecord& record, Window window);

void write_report_json(const std::filesystem::path& file, const FlightReport& report);

// Writes folder/flight.gp, which draws folder/flight.png from folder/flight.csv, and runs gnuplot on it.
// Returns an empty text, or one sentence that says why there is no picture.
std::string draw_flight(const std::filesystem::path& folder, const FlightReport& report, Window window);

}  // namespace swiftlet::ground
