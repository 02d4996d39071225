// Mission files (YAML). docs/missions.md describes the format for authors,
// config/missions/mission.schema.json for text editors:
//
//   name: square         # optional; default: the file name without its extension
//   description: One lap # optional
//   frame: ned           # of positions and yaws: ned (north, east, down), enu (east, north, up) or nwu (north, west, up)
//   tolerance_m: 0.1     # largest peak 3-D tracking error of a completed mission
//   limits: {speed_m_s: 1, acceleration_m_s2: 1.5, jerk_m_s3: 10, yaw_rate_rad_s: 1}   # optional, each
//   geofence: {min_m: [-1, -1, -2], max_m: [3, 3, 0.2]}                                # optional; corners
//   items:
//     - {kind: set, speed_m_s: 0.5, acceptance_radius_m: 0.05}  # defaults of the items after it
//     - {kind: takeoff, height_m: 1.0, hold_s: 2}                  # straight up to this height
//     - {kind: waypoint, position_m: [2, 0, -1], yaw_rad: 0, speed_m_s: 0.5, hold_s: 1}
//     - {kind: path, points: [[2, 0, -1], {position_m: [2, 2, -1], yaw_rad: 0}, [0, 0, -1]]}
//     - {kind: trajectory, file: figure8.csv}                      # path relative to the mission file
//     - {kind: wait, duration_s: 3}
//     - {kind: land, speed_m_s: 0.3}                               # straight down, then rotors off
//
// Limits and fence can only be tighter than those of the control settings. Files of other projects are read
// too (mission_format.hpp).
#pragma once

#include <string>
#include <vector>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/io/missions/file_options.hpp"

namespace swiftlet::io {

// A path in NED that begins at rest, and the assumptions made in reading it.
struct TrajectoryFile {
  std::vector<control::PolynomialSegment> segments;
  std::vector<std::string> assumptions;
};

struct MissionFile {
  std::string name;
  std::string description;
  double tolerance_m = 0.0;
  control::Mission mission;              // in NED; its id is 0
  std::vector<int> lines;                // line of each item, from 1; empty for files of other projects
  std::vector<std::string> assumptions;  // made in reading a file of another project, as sentences
  bool is_path = false;                  // of a file that has the path only: take-off and landing were added

  bool takes_off() const;
  bool lands() const;
};

// All throw io::ConfigError with file, line, key, value and limit for a violation of the format, the
// limits or the fence. load_mission_file() and parse_any_mission_file() read any supported format,
// parse_mission_file() YAML only.
// Trajectory files are searched in the folder of file_name. Options that do not apply to the format of the file
// are refused.
MissionFile load_mission_file(const std::string& path, const control::Limits& limits,
                              const FileOptions& options = {});
MissionFile parse_any_mission_file(const std::string& text, const std::string& file_name,
                                   const control::Limits& limits, const FileOptions& options = {});
MissionFile parse_mission_file(const std::string& text, const std::string& file_name,
                               const control::Limits& limits, const FileOptions& options = {});

// Reads only the path: a CSV file of any format, or the trajectory of a mission that holds exactly one. Throws
// io::ConfigError as load_mission_file() does.
TrajectoryFile load_trajectory_file(const std::string& path, const control::Limits& limits,
                                    const FileOptions& options = {});

// The same flight, `factor` times as slow, > 0, as --time-scale makes it: of a path of another project the path alone, else
// also the moves.
MissionFile stretched(MissionFile file, double factor);

// Returns the duration of the mission, s, from the ground at the origin. Moves take the items' speeds and the
// limits of acceleration, jerk and yaw rate.
double planned_duration_s(const control::Mission& mission, const control::Limits& settings);

}  // namespace swiftlet::io
