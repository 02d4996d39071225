// Recorded flights side by side: the result of each, and the settings in which they differ.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "swiftlet/analysis/report/recorded_flights.hpp"

namespace swiftlet::analysis {

// Tables for a terminal with one column per flight; "-" marks a missing value. The results, and how many settings of several flights
// differ.
std::string comparison_table(const std::vector<RecordedFlight>& flights);
// The control settings of a single flight, or the settings in which several differ.
std::string settings_table(const std::vector<RecordedFlight>& flights);

// {"flights": [{"folder", "report", "settings": {...}}], "differ": [keys]}
nlohmann::ordered_json comparison_json(const std::vector<RecordedFlight>& flights);

}  // namespace swiftlet::analysis
