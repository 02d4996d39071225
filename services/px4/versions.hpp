// Which version of PX4 is there. PX4 puts the version of a message behind the name of its topic: vehicle_status_v1. A reader of
// another version receives nothing, or misreads.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace swiftlet::px4 {

enum class VersionState {
  kNoTopics,  // PX4 publishes nothing, or not yet
  kKnown,     // 1.16
  kUnknown,
};

struct Version {
  VersionState state = VersionState::kNoTopics;
  std::string fault;  // if unknown: a sentence with the name of the topic
};

// wire_names: of the topics that the processes of the domain publish. folder: Px4Topics::folder.
Version version_of(const std::vector<std::string>& wire_names, const std::string& folder);

}  // namespace swiftlet::px4
