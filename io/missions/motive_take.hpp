// Takes that OptiTrack's Motive exports as CSV, format versions 1.1 to 1.25:
//
//   Format Version,1.23,...,Rotation Type,Quaternion,Length Units,Meters,Coordinate Space,Global
//   ,,Rigid Body,...                             the kind of what a column belongs to; its name; more lines
//   ,,Rotation,...,Position,...
//   Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,...
//   0,0.000000,0.03,...                          cells are empty where a body was not seen
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "swiftlet/io/missions/mission_frame.hpp"
#include "swiftlet/io/missions/mission_table.hpp"

namespace swiftlet::io {

bool is_motive_take(std::string_view content);

// Returns the columns t, x, y, z and, if the take has quaternions, yaw of its rigid body, a row for each frame that has
// it. Without a frame, Y is up, x forward and z to the right, as `--frame yup` of the motion capture: the columns are in NED.
// With one they name none. Throws ConfigError unless there is exactly one rigid body, in global coordinates.
MissionTable read_motive_take(std::string_view text, const std::string& file_name,
                              std::optional<MissionFrame> frame);

}  // namespace swiftlet::io
