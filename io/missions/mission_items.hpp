// Reads the items of a mission file.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/io/config.hpp"
#include "swiftlet/io/missions/mission_file.hpp"

namespace swiftlet::ground {

// Reads list into file.mission, file.lines and file.assumptions. limits are those of the control settings,
// tightened by the mission. Throws runtime::ConfigError.
void read_mission_items(const runtime::ConfigNode& list, MissionFrame frame, const Placement& placement,
                        const control::Limits& limits, MissionFile& file);

}  // namespace swiftlet::ground
