// Recorded flights side by side: the result of each, and the settings in which they differ.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "swiftlet/analysis/report/recorded_flights.hpp"

namespace swiftlet::analysis {

// Returns a table for a terminal with one column per flight. For one flight: its results and all its control
// settings. For several: their results, and the settings in which they differ; "-" marks a missing value.
std::string comparison_table(const std::vector<RecordedFlight>& flights);

// {"flights": [{"folder", "report", "settings": {...}}], "differ": [keys]}
nlohmann::ordered_json comparison_json(const std::vector<RecordedFlight>& flights);

}  // namespace swiftlet::analysis
