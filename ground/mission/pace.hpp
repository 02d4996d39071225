// Reads mission files as commands are told to: also as fast as a vehicle can fly them.
#pragma once

#include <string>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/ground/mission/mission_check.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {

struct ReadingOptions : io::FileOptions {
  bool as_fast_as_possible = false;
  double reserve = 0.1;  // 0 .. 1, see CheckConditions; with as_fast_as_possible
};

// How fast a mission can be flown.
struct Pace {
  double time_scale = 1.0;  // the least, to three digits
  std::string limit;        // what would be exceeded if it were flown faster, where and when; empty: nothing
};

// The least time scale at which the vehicle can fly the mission by check_mission(), with the reserve of the conditions.
// Throws io::ConfigError with the reason if there is none up to kLargestTimeScale.
Pace fastest_pace(const io::MissionFile& file, const plant::Vehicle& vehicle,
                  const control::ControlSettings& settings, const CheckConditions& conditions);

// As load_mission_file() and load_trajectory_file(). With as_fast_as_possible the time scale of the options is multiplied by that
// of fastest_pace(), and the assumptions say by what, which limit is met, and where.
io::MissionFile load_mission(const std::string& path, const ReadingOptions& options,
                             const plant::Vehicle& vehicle, const control::ControlSettings& settings);
io::TrajectoryFile load_trajectory(const std::string& path, const ReadingOptions& options,
                                   const plant::Vehicle& vehicle, const control::ControlSettings& settings);

// A mission that only flies this path: the vehicle hovers below or above its start.
io::MissionFile mission_of(const std::string& name, const io::TrajectoryFile& path,
                           const control::ControlSettings& settings);
// Where it hovers.
CheckConditions at_start_of(const io::TrajectoryFile& path);

}  // namespace swiftlet::ground
