// Writes the files of a flight record beside flight.mcap: report.json, flight.gp and flight.png.
#pragma once

#include <filesystem>
#include <string>

#include "swiftlet/analysis/report/flight_report.hpp"
#include "swiftlet/record/evaluation.hpp"

namespace swiftlet::analysis {

void write_report_json(const std::filesystem::path& file, const FlightReport& report);

// Draws folder/flight.png, and writes the gnuplot script folder/flight.gp to draw it again. window: of the errors. Returns an
// empty string, or a sentence if gnuplot is not installed. Throws std::runtime_error if the picture could not be
// drawn or written whole; there is none then.
std::string draw_flight(const std::filesystem::path& folder, const record::Flight& flight,
                        const FlightReport& report, record::Window window);

}  // namespace swiftlet::analysis
