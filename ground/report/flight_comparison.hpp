// Recorded flights side by side: what each came to, and in which settings they differ.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace swiftlet::ground {

struct RecordedFlight {  // NOLINT(bugprone-exception-escape): ordered_json is moved without one
  std::filesystem::path folder;
  nlohmann::ordered_json report;  // report.json
  std::vector<std::pair<std::string, std::string>> settings;
};

// Throws InputError for a folder that holds no flight, runtime::ConfigError for a file of it that cannot be
// read.
RecordedFlight load_recorded_flight(const std::filesystem::path& folder);

// The newest flight below a folder, by the time of its report. Throws InputError if there is none.
std::filesystem::path newest_flight(const std::filesystem::path& below);

// For a terminal, a column for each flight. One flight: its figures and all settings of its loops. Several:
// figures, then the settings in which they differ; one that a flight does not have is "-".
std::string comparison_table(const std::vector<RecordedFlight>& flights);

// {"flights": [{"folder", "report", "settings": {...}}], "differ": [keys]}
nlohmann::ordered_json comparison_json(const std::vector<RecordedFlight>& flights);

}  // namespace swiftlet::ground
