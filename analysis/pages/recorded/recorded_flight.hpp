// A recorded flight as the page shows it.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/analysis/pages/flight_log.hpp"
#include "swiftlet/record/flight.hpp"
#include "swiftlet/record/mcap/reader.hpp"

namespace swiftlet::pages {

// What was read of a vehicle in this file. name: for the reader of the page. Throws ConfigError without any estimate or ground truth.
FlightLog flight_log(const mcap::Reader& file, const std::string& vehicle, const record::Flight& recorded,
                     const std::string& name);

}  // namespace swiftlet::pages
