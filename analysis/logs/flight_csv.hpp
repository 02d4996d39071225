// A recorded flight as a table: ground truth, reference, estimate and rotors over time.
#pragma once

#include <filesystem>

#include "swiftlet/record/flight.hpp"

namespace swiftlet::analysis {

// One row for each reference whose ground truth is known. Cells of an estimate or command of another stamp are empty. Time 0 is the start of
// the mission, or of the flight without one. The header names frame and unit of each column; docs/csv.md describes them. Throws
// std::runtime_error if the file cannot be written.
void write_flight_csv(const std::filesystem::path& file, const record::Flight& flight);

}  // namespace swiftlet::analysis
