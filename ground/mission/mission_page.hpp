// The page of a mission before it is flown: the path in space with the fence; position, speed, acceleration and tilt over
// time, with their limits.
#pragma once

#include <string>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/ground/mission/dry_run.hpp"
#include "swiftlet/io/missions/mission_file.hpp"

namespace swiftlet::ground {

// limits: of the control settings. HTML.
std::string mission_page(const io::MissionFile& file, const MissionDryRun& dry_run,
                         const control::Limits& limits);

}  // namespace swiftlet::ground
