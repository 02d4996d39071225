// The flights in an MCAP file.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/ground/pages/flight_log.hpp"
#include "swiftlet/record/mcap/reader.hpp"

namespace swiftlet::pages {

// One for each vehicle in the file. name: for the reader. Throws ConfigError for a damaged file, and for one without
// any estimate or ground truth.
std::vector<FlightLog> flights_in(const mcap::Reader& file, const std::string& name);

}  // namespace swiftlet::pages
