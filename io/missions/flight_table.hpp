// The table of a flight as input, as `swiftlet log csv` writes it: its reference, to fly it again.
#pragma once

#include <string>
#include <string_view>

#include "swiftlet/io/table.hpp"

namespace swiftlet::io {

// Returns the reference of a recorded flight from take-off to landing: from the first to the last row at
// which it is at rest and at least 0.2 m above the ground. Columns: t, position, velocity, acceleration and yaw
// in NED, as motion_columns.hpp names them; without acceleration for a record of an older version. Throws
// io::ConfigError.
Table reference_of_flight(std::string_view text, const std::string& file_name);

// A sentence: which part of the flight the table holds.
std::string extent_of(const Table& reference);

}  // namespace swiftlet::io
