// Files of other projects that are flown as missions. Each is turned into a whole flight in NED, take-off
// and landing included, and says in MissionFile::assumptions what it was taken for.
//
//   polynomial CSV      duration,x^0..x^7,y^0..y^7,z^0..z^7,yaw^0..yaw^7   as Crazyswarm and uav_trajectories have it
//   sampled CSV         t,x,y,z[,vx,vy,vz[,ax,ay,az]][,yaw]
//   waypoint CSV        x,y,z[,yaw], with or without a header line
//   QGroundControl      .plan, JSON: a simple mission with a planned home position
//
// CSV files are in ENU: m and s, yaw in rad counter-clockwise from east.
#pragma once

#include <string>
#include <string_view>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/io/missions/mission_file.hpp"

namespace swiftlet::ground {

enum class MissionFormat { kYaml, kPolynomialCsv, kSampledCsv, kWaypointCsv, kQGroundControlPlan };

// By content; file_name counts for messages and where the content leaves it open. Throws runtime::ConfigError
// for a CSV file that is none of these.
MissionFormat detect_format(std::string_view text, const std::string& file_name);

// A path in NED that begins at rest, and what it was taken for.
struct TrajectoryFile {
  std::vector<control::PolynomialSegment> segments;
  std::vector<std::string> assumptions;
};

// All that follow throw runtime::ConfigError with file, line, column, value and limit for whatever breaks
// the form, the limits or the fence.
TrajectoryFile read_polynomial_csv(const std::string& text, const std::string& file_name,
                                   const control::Limits& limits);
TrajectoryFile read_sampled_csv(const std::string& text, const std::string& file_name,
                                const control::Limits& limits);
TrajectoryFile read_waypoint_csv(const std::string& text, const std::string& file_name,
                                 const control::Limits& limits);

// Whole flights.
MissionFile parse_polynomial_csv(const std::string& text, const std::string& file_name,
                                 const control::Limits& limits);
MissionFile parse_sampled_csv(const std::string& text, const std::string& file_name,
                              const control::Limits& limits);
MissionFile parse_waypoint_csv(const std::string& text, const std::string& file_name,
                               const control::Limits& limits);
MissionFile parse_qgroundcontrol_plan(const std::string& text, const std::string& file_name,
                                      const control::Limits& limits);

}  // namespace swiftlet::ground
