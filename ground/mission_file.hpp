// Mission files (YAML):
//
//   name: square         # optional; the file's name without its ending
//   description: One lap # optional
//   frame: ned           # of the positions and yaws: ned (north, east, down) or enu (east, north, up)
//   tolerance_m: 0.1     # peak 3-D tracking error with which the mission still counts as completed
//   items:
//     - {kind: takeoff, height_m: 1.0, speed_m_s: 0.5, hold_s: 2}  # straight up, to this height
//     - {kind: waypoint, position_m: [2, 0, -1], yaw_rad: 0, speed_m_s: 0.5, hold_s: 1}
//     - {kind: land, speed_m_s: 0.3}                               # straight down, rotors off
//
// yaw_rad and hold_s may be left out: the yaw is then kept, and the flight goes on at once. A takeoff stands
// first, a land last. Files of other projects are read as well (formats/mission_format.hpp).
#pragma once

#include <string>
#include <vector>

#include "control/mission.hpp"
#include "control/settings.hpp"

namespace swiftlet::ground {

struct MissionFile {
  std::string name;
  std::string description;
  double tolerance_m = 0.0;
  control::Mission mission;              // in NED; its id is left 0
  std::vector<std::string> assumptions;  // what a file of another project was taken for, as sentences

  bool takes_off() const;
  bool lands() const;
};

// Throw runtime::ConfigError with file, line, key, value and limit for whatever breaks the form, the limits
// or the fence. load: of any format that is known; parse: YAML.
MissionFile load_mission_file(const std::string& path, const control::Limits& limits);
MissionFile parse_mission_file(const std::string& text, const std::string& file_name,
                               const control::Limits& limits);

// How long the mission takes from the ground at the origin, at the latest by what the limits allow.
double planned_duration_s(const control::Mission& mission, const control::Limits& limits);

const char* to_string(control::MissionItemKind kind);

}  // namespace swiftlet::ground
