// Reads files of other projects as missions. Each is converted to a complete flight in NED with take-off and
// landing. MissionFile::assumptions states how the file was interpreted.
//
//   polynomial CSV      duration,x^0..x^7,y^0..y^7,z^0..z^7,yaw^0..yaw^7 (Crazyswarm, uav_trajectories)
//   sampled CSV         t, x, y, z and, if given, vx, vy, vz, ax, ay, az, yaw
//   take of Motive      a rigid body of an OptiTrack system (motive_take.hpp)
//   log of a Crazyflie  its estimated position (crazyflie_log.hpp)
//   flight.csv          of `swiftlet log csv`: its reference between take-off and landing
//   waypoint CSV        x, y, z and, if given, yaw; or x,y,z[,yaw] without a header line
//   QGroundControl      .plan, JSON: a simple mission with a planned home position; or a list of waypoints (plan.hpp)
//
// Columns, frames and units of CSV files are those of motion_columns.hpp. Polynomials and waypoints without a
// header name no frame: they are in ENU, m, rad and s, unless --frame names another.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/io/missions/file_options.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/missions/mission_table.hpp"
#include "swiftlet/io/missions/plan.hpp"

namespace swiftlet::io {

constexpr std::size_t kMaxPoints = control::kMaxTrajectorySegments + 1;  // of a path through waypoints

// A file as the functions below read it. The format says which of the three it has.
struct Source {
  MissionFormat format = MissionFormat::kYaml;
  std::string text;            // of a mission file
  std::optional<Plan> plan;    // of QGroundControl
  std::optional<Table> table;  // of a path
  std::vector<std::string> assumptions;
};

// Reads a file and detects its format from the content, or from the extension if the content is ambiguous. Throws
// io::ConfigError, also for a CSV file of another format, and for options that the format does not have.
Source read_source(const std::string& path, const FileOptions& options = {});
Source parse_source(const std::string& text, const std::string& file_name, const FileOptions& options = {});

// All functions below throw io::ConfigError with file, line, column, value and limit for a violation of the
// format, the limits or the fence.
TrajectoryFile read_polynomials(const Table& table, const control::Limits& limits,
                                const FileOptions& options);
TrajectoryFile read_samples(const Table& table, const control::Limits& limits, const FileOptions& options);
TrajectoryFile read_waypoints(const Table& table, const control::Limits& limits, const FileOptions& options);

// The path of a table, whichever it holds, and the assumptions of the source. Nothing if the source is no table.
std::optional<TrajectoryFile> path_of(const Source& source, const control::Limits& limits,
                                      const FileOptions& options);

}  // namespace swiftlet::io
