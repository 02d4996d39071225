// Plots a mission before it is flown: the path from above and in 3-D; height, speed, acceleration and tilt
// over time, with limits and fence.
#pragma once

#include <filesystem>
#include <string>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/ground/mission/dry_run.hpp"
#include "swiftlet/io/missions/mission_file.hpp"

namespace swiftlet::ground {

// limits: of the control settings. Returns an empty string, or a sentence that says why there is no plot.
std::string draw_mission(const std::filesystem::path& png, const io::MissionFile& file,
                         const MissionDryRun& dry_run, const control::Limits& limits);

}  // namespace swiftlet::ground
