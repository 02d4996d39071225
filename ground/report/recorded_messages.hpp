// Flights in an MCAP file of recorded messages, as recorded flights.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "swiftlet/ground/report/flight_comparison.hpp"
#include "swiftlet/io/mcap/reader.hpp"
#include "swiftlet/recording/tracking.hpp"

namespace swiftlet::ground {

// The first mission that a vehicle has flown in a file. Errors are NaN without ground truth and reference: that of a
// real vehicle is not known.
struct FlownMission {
  bool flown = false;  // it was started
  bool completed = false;
  std::string reason;       // why it was not completed
  double duration_s = 0.0;  // from its start to its end, or to that of the file
  TrackingErrors errors;    // from its start to the landing
};

// Throws ConfigError if a message does not fit its schema.
FlownMission flown_mission(const mcap::Reader& file, const std::string& vehicle);

// One flight for each vehicle in the file, with results from its messages and the settings that it has as attachments.
// Throws ConfigError if it is not such a file.
std::vector<RecordedFlight> load_recorded_messages(const std::filesystem::path& file);

}  // namespace swiftlet::ground
