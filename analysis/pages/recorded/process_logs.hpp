// The logs of the processes of a flight, swiftlet-plant.log and so on, which `swiftlet fly` writes beside flight.mcap.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "swiftlet/analysis/pages/flight_log.hpp"

namespace swiftlet::pages {

// Adds the lines of the logs in a folder that fall into the flight as events. Their times of day are those of this
// computer's zone. A flight in simulated time gets none: its logs have the times of the wall clock. Throws ConfigError if a
// log cannot be read. vehicles: all in the record; what a log says of another one than that of the flight is left out.
void add_process_logs(const std::filesystem::path& folder, const std::vector<std::string>& vehicles,
                      FlightLog& flight);

}  // namespace swiftlet::pages
