#include "swiftlet/plant/model/control_level.hpp"

#include <algorithm>
#include <cstddef>

namespace swiftlet::plant {

const char* to_string(ControlLevel level) {
  switch (level) {
    case ControlLevel::kActuators:
      return "actuators";
    case ControlLevel::kRates:
      return "rates";
    case ControlLevel::kAttitude:
      return "attitude";
    case ControlLevel::kTrajectory:
      return "trajectory";
  }
  return "";
}

std::optional<ControlLevel> control_level_from(std::string_view name) {
  for (const ControlLevel level : kControlLevels) {
    if (name == to_string(level)) return level;
  }
  return std::nullopt;
}

ControlLevel ControlLevels::lowest() const {
  for (const ControlLevel level : kControlLevels) {
    if (has(level)) return level;
  }
  return ControlLevel::kActuators;
}

ControlLevels::Names ControlLevels::names() const {
  Names names{};
  std::size_t length = 0;
  const auto append = [&](std::string_view text) {
    std::copy(text.begin(), text.end(), names.begin() + length);
    length += text.size();
  };
  for (const ControlLevel level : kControlLevels) {
    if (!has(level)) continue;
    if (length > 0) append(", ");
    append(to_string(level));
  }
  return names;
}

std::optional<ControlLevels> control_levels_from(std::string_view list) {
  ControlLevels levels;
  while (true) {
    const std::size_t end = std::min(list.find(','), list.size());
    const std::optional<ControlLevel> level = control_level_from(list.substr(0, end));
    if (!level) return std::nullopt;
    levels.add(*level);
    if (end == list.size()) return levels;
    list.remove_prefix(end + 1);
  }
}

}  // namespace swiftlet::plant
