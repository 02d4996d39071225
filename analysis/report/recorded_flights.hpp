// Recorded flights with their results and settings.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "swiftlet/record/flight.hpp"

namespace swiftlet::analysis {

struct RecordedFlight {  // NOLINT(bugprone-exception-escape): ordered_json is moved without one
  std::filesystem::path record;
  std::string name;  // of the record; RECORD/VEHICLE for one of several vehicles
  nlohmann::ordered_json
      report;  // as report.json, from the messages; of a flight of `swiftlet fly` with its timing
  // Keys and values in the files of the flight, such as "control.position.x.omega_n" and "2.0".
  std::vector<std::pair<std::string, std::string>> settings;
  std::string vehicle;
  std::filesystem::path file;  // of its messages
  record::Flight flown;
};

// The flights of a record, one for each vehicle; of the folder of a vehicle that one. Throws io::ConfigError
// for a folder without one, a damaged file, or one without messages of a vehicle.
std::vector<RecordedFlight> load_record(const std::filesystem::path& record);

// Returns the newest record in a folder. Throws InputError if there is none.
std::filesystem::path newest_record(const std::filesystem::path& below);

}  // namespace swiftlet::analysis
