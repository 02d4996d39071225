// Reads the items of a mission file.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/io/config.hpp"
#include "swiftlet/io/missions/mission_file.hpp"

namespace swiftlet::io {

// Reads list into file.mission, file.lines and file.assumptions. limits are those of the control settings,
// tightened by the mission. Trajectory files need to keep to them only where they are flown time_scale times as
// slow; the segments are those of the files. Throws io::ConfigError.
void read_mission_items(const io::ConfigNode& list, MissionFrame frame, const Placement& placement,
                        double time_scale, const control::Limits& limits, MissionFile& file);

}  // namespace swiftlet::io
