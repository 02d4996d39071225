// A picture of a mission before it is flown: the path from above and in space, height, speed, acceleration
// and tilt against time, with limits and fence.
#pragma once

#include <filesystem>
#include <string>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/ground/mission/dry_run.hpp"
#include "swiftlet/io/missions/mission_file.hpp"

namespace swiftlet::ground {

// limits: the settings'. Returns an empty text, or one sentence that says why there is no picture.
std::string draw_mission(const std::filesystem::path& png, const MissionFile& file,
                         const MissionDryRun& dry_run, const control::Limits& limits);

}  // namespace swiftlet::ground
