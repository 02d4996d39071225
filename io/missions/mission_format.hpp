// Reads files of other projects as missions. Each is converted to a complete flight in NED with take-off and
// landing. MissionFile::assumptions states how the file was interpreted.
//
//   polynomial CSV      duration,x^0..x^7,y^0..y^7,z^0..z^7,yaw^0..yaw^7 (Crazyswarm, uav_trajectories)
//   sampled CSV         t, x, y, z and, if given, vx, vy, vz, ax, ay, az, yaw
//   log of a Crazyflie  its estimated position (crazyflie_log.hpp)
//   flight.csv          of `swiftlet log csv`: its reference between take-off and landing
//   waypoint CSV        x, y, z and, if given, yaw; or x,y,z[,yaw] without a header line
//   QGroundControl      .plan, JSON: a simple mission with a planned home position
//
// Columns, frames and units of CSV files are those of motion_columns.hpp. Polynomials and waypoints without a
// header name no frame: they are in ENU, m, rad and s, unless --frame names another.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/io/missions/file_options.hpp"
#include "swiftlet/io/missions/mission_file.hpp"

namespace swiftlet::io {

constexpr std::size_t kMaxPoints = control::kMaxTrajectorySegments + 1;  // of a path through waypoints

enum class MissionFormat { kYaml, kPolynomialCsv, kSampledCsv, kWaypointCsv, kQGroundControlPlan };

// A file as the functions below read it.
struct Source {
  MissionFormat format = MissionFormat::kYaml;
  std::string
      text;  // tables and logs of other programs are in the dialect of ours, and lists of waypoints a .plan
  int first_line = 1;  // of the text in the file
  std::vector<std::string> assumptions;
};

// Reads a file and detects its format. Throws io::ConfigError, also for options that the format does not have.
Source read_source(const std::string& path, const FileOptions& options = {});

// Detects the format from the content, or from the extension of file_name if the content is ambiguous. Throws
// io::ConfigError for a CSV file of another format.
MissionFormat detect_format(std::string_view text, const std::string& file_name);

// first_line: of the text in the file, for messages. All functions below throw io::ConfigError with file,
// line, column, value and limit for a violation of the format, the limits or the fence.
TrajectoryFile read_polynomial_csv(const std::string& text, const std::string& file_name,
                                   const control::Limits& limits, const FileOptions& options = {},
                                   int first_line = 1);
TrajectoryFile read_sampled_csv(const std::string& text, const std::string& file_name,
                                const control::Limits& limits, const FileOptions& options = {},
                                int first_line = 1);
TrajectoryFile read_waypoint_csv(const std::string& text, const std::string& file_name,
                                 const control::Limits& limits, const FileOptions& options = {},
                                 int first_line = 1);

// Complete flights: take-off, the path, landing.
MissionFile parse_polynomial_csv(const std::string& text, const std::string& file_name,
                                 const control::Limits& limits, const FileOptions& options = {},
                                 int first_line = 1);
MissionFile parse_sampled_csv(const std::string& text, const std::string& file_name,
                              const control::Limits& limits, const FileOptions& options = {},
                              int first_line = 1);
MissionFile parse_waypoint_csv(const std::string& text, const std::string& file_name,
                               const control::Limits& limits, const FileOptions& options = {},
                               int first_line = 1);
MissionFile parse_qgroundcontrol_plan(const std::string& text, const std::string& file_name,
                                      const control::Limits& limits, const FileOptions& options = {});

}  // namespace swiftlet::io
