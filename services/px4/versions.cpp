#include "swiftlet/services/px4/versions.hpp"

#include <fmt/core.h>

namespace swiftlet::px4 {
namespace {

struct Message {
  const char* topic;
  int version;  // in PX4 1.16; 0: no suffix
};
constexpr Message kMessages[] = {
    {"vehicle_status", 1},   {"battery_status", 0},      {"sensor_combined", 0},
    {"vehicle_odometry", 0}, {"vehicle_command_ack", 0}, {"vehicle_land_detected", 0},
};

std::string with_version(const std::string& topic, int version) {
  return version == 0 ? topic : topic + "_v" + std::to_string(version);
}

// "vehicle_status_v4" of the topic "vehicle_status".
bool is_version_of(const std::string& topic, const std::string& name) {
  if (name == topic) return true;
  const std::string prefix = topic + "_v";
  return name.rfind(prefix, 0) == 0 && name.size() > prefix.size() &&
         name.find_first_not_of("0123456789", prefix.size()) == std::string::npos;
}

}  // namespace

Version version_of(const std::vector<std::string>& wire_names, const std::string& folder) {
  const std::string prefix = "rt" + folder + "/out/";
  Version version;
  for (const Message& message : kMessages) {
    const std::string known = with_version(message.topic, message.version);
    std::string other;
    bool is_known = false;
    for (const std::string& wire_name : wire_names) {
      if (wire_name.rfind(prefix, 0) != 0) continue;
      const std::string name = wire_name.substr(prefix.size());
      if (name == known) is_known = true;
      if (name != known && is_version_of(message.topic, name)) other = name;
    }
    if (is_known) {
      if (message.version > 0 && version.state == VersionState::kNoTopics)
        version.state = VersionState::kKnown;
    } else if (!other.empty()) {
      return {VersionState::kUnknown,
              fmt::format("PX4 publishes {}{}, but swiftlet-px4 knows {}, that of PX4 1.16", folder + "/out/",
                          other, known)};
    }
  }
  return version;
}

}  // namespace swiftlet::px4
