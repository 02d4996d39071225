// Recorded flights side by side: the result of each, and the settings in which they differ.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace swiftlet::ground {

struct RecordedFlight {  // NOLINT(bugprone-exception-escape): ordered_json is moved without one
  std::filesystem::path folder;
  std::string name;               // of the folder; FOLDER/VEHICLE for one of several vehicles
  nlohmann::ordered_json report;  // report.json
  std::vector<std::pair<std::string, std::string>> settings;
};

// Throws InputError for a folder without a flight record, runtime::ConfigError for an invalid file in the
// record.
RecordedFlight load_recorded_flight(const std::filesystem::path& folder);

// Returns the folders of the flights in a record: the record itself, or one for each of several vehicles, in
// order of their names. Throws InputError if it contains no flight.
std::vector<std::filesystem::path> flights_of(const std::filesystem::path& record);

// Returns the newest record in a folder, of one or of several vehicles, by the time of its reports. Throws
// InputError if there is none.
std::filesystem::path newest_record(const std::filesystem::path& below);

// Returns a table for a terminal with one column per flight. For one flight: its results and all its control
// settings. For several: their results, and the settings in which they differ; "-" marks a missing value.
std::string comparison_table(const std::vector<RecordedFlight>& flights);

// {"flights": [{"folder", "report", "settings": {...}}], "differ": [keys]}
nlohmann::ordered_json comparison_json(const std::vector<RecordedFlight>& flights);

}  // namespace swiftlet::ground
