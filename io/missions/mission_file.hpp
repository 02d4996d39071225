// Mission files (YAML). docs/missions.md explains them to their writers,
// config/missions/mission.schema.json to editors:
//
//   name: square         # optional; the file's name without its ending
//   description: One lap # optional
//   frame: ned           # of the positions and yaws: ned (north, east, down) or enu (east, north, up)
//   tolerance_m: 0.1     # peak 3-D tracking error with which the mission still counts as completed
//   limits: {speed_m_s: 1, acceleration_m_s2: 1.5, jerk_m_s3: 10, yaw_rate_rad_s: 1}   # optional, each
//   geofence: {min_m: [-1, -1, -2], max_m: [3, 3, 0.2]}                                # optional; corners
//   items:
//     - {kind: set, speed_m_s: 0.5, acceptance_radius_m: 0.05}  # for those after it, unless they say
//     - {kind: takeoff, height_m: 1.0, hold_s: 2}                  # straight up, to this height
//     - {kind: waypoint, position_m: [2, 0, -1], yaw_rad: 0, speed_m_s: 0.5, hold_s: 1}
//     - {kind: path, points: [[2, 0, -1], {position_m: [2, 2, -1], yaw_rad: 0}, [0, 0, -1]]}
//     - {kind: trajectory, file: figure8.csv}                      # beside the mission file
//     - {kind: wait, duration_s: 3}
//     - {kind: land, speed_m_s: 0.3}                               # straight down, rotors off
//
// Limits and fence can only be tighter than those of the control settings. Files of other projects are read
// as well (formats/mission_format.hpp).
#pragma once

#include <string>
#include <vector>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::ground {

struct MissionFile {
  std::string name;
  std::string description;
  double tolerance_m = 0.0;
  control::Mission mission;  // in NED; its id is left 0
  std::vector<int> lines;    // of each of its items in the file, from 1; empty for files of other projects
  std::vector<std::string> assumptions;  // what a file of another project was taken for, as sentences

  bool takes_off() const;
  bool lands() const;
};

// Throw runtime::ConfigError with file, line, key, value and limit for whatever breaks the form, the limits
// or the fence. load: of any format that is known; parse: YAML. file_name: its folder is where trajectories
// are looked for.
MissionFile load_mission_file(const std::string& path, const control::Limits& limits);
MissionFile parse_mission_file(const std::string& text, const std::string& file_name,
                               const control::Limits& limits);

// How long the mission takes from the ground at the origin, at the latest by what the limits allow.
double planned_duration_s(const control::Mission& mission, const control::Limits& settings);

const char* to_string(control::MissionItemKind kind);

}  // namespace swiftlet::ground
