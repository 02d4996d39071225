// The table of a flight as input, as `swiftlet log csv` writes it: its reference, to fly it again.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "swiftlet/io/csv.hpp"

namespace swiftlet::io {

// The columns of the first line of a table, without the empty one after a comma at its end. Throws
// io::ConfigError if the text has control characters.
std::vector<std::string> table_header(std::string_view text, const std::string& file_name);

// Returns the reference of a recorded flight from take-off to landing: from the first to the last row at
// which it is at rest and at least 0.2 m above the ground. Columns: t, position, velocity, acceleration and yaw
// in NED, as motion_columns.hpp names them; without acceleration for a record of an older version. Throws
// io::ConfigError.
io::CsvTable reference_of_flight(const std::string& text, const std::string& file_name);

// A sentence: which part of the flight the table holds.
std::string extent_of(const io::CsvTable& reference);

}  // namespace swiftlet::io
