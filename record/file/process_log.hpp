// The lines of the processes' own logs, swiftlet-plant.log and so on, which `swiftlet fly` writes beside flight.mcap.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "swiftlet/record/file/standard_message.hpp"
#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::record {

struct ProcessLogLine {
  std::int64_t time_ns = 0;  // since 1970
  std::string process;       // "control"
  std::string level;         // of spdlog: "info"
  std::string text;
};

// The lines of the logs in a folder. A line holds only its time of day, in the zone of this computer: its day is the one that
// brings it nearest to near_ns, since 1970. Lines of another form are left out. Throws ConfigError if a log cannot be read.
std::vector<ProcessLogLine> process_log_lines(const std::filesystem::path& folder, std::int64_t near_ns);

// The message for topic /log.
StandardMessage log_message(const ProcessLogLine& line);

}  // namespace swiftlet::record
