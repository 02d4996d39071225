// Publishes the messages of a recorded file again, with their timing.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "swiftlet/record/mcap/reader.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

struct ReplaySettings {
  mcap::Selection selection{};               // of the file
  std::map<std::string, std::string> names;  // of the vehicle in the file: that under which it is published
  double speed = 1.0;                        // times as fast as recorded
};

struct ReplayTotals {
  std::uint64_t published = 0;
  std::uint64_t refused = 0;     // messages of other types or versions than those of the topics
  double time_s = 0.0;           // of the file
  double largest_delay_s = 0.0;  // by which a message was published too late
};

// The messages of the vehicles in settings.names, on the topics of Swiftlet. proceed: called before each message with the
// totals so far; false ends the replay. Throws ConfigError for a damaged file, std::runtime_error if a topic cannot be
// published.
ReplayTotals replay(const mcap::Reader& file, const dds::Participant& participant,
                    const ReplaySettings& settings, const std::function<bool(const ReplayTotals&)>& proceed);

}  // namespace swiftlet::ground
