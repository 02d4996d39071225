// An HTML page of flights, in one file without network access: paths in space, charts of all signals over one
// time axis, modes and events, and a table of results. Several flights are laid over each other.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/analysis/pages/flight_log.hpp"

namespace swiftlet::pages {

// note: what a reader should know about the data.
std::string flight_page(const std::string& title, const std::string& note,
                        const std::vector<FlightLog>& flights);

}  // namespace swiftlet::pages
