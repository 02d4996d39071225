// Fleet files (YAML): vehicles that fly together in one frame. docs/swarms.md describes the format for authors,
// config/fleets/fleet.schema.json for text editors:
//
//   name: crossing          # optional; default: the file name without its extension
//   description: Two paths  # optional
//   frame: enu              # of the starting places, and of CSV files that name none: ned or enu
//   vehicle: crazyflie2     # optional; of vehicles that name none; default: kaylion
//   control: motor_lag      # optional; control settings of all
//   simulation: default     # optional; simulation settings of all
//   safety: {radius_xy_m: 0.15, radius_z_m: 0.3}       # ellipsoid about each vehicle that no other's touches
//   vehicles:
//     - {name: cf1, start_m: [0, 1], mission: cf1.csv}  # place on the ground; mission in the frame of the fleet
//     - {name: cf2, start_m: [0, -1], mission: hop, origin: start, vehicle: kaylion, priority: 2}
//
// Missions and vehicles are files in the folder of the fleet file, or below it, or names in config.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/ground/fleet/separation.hpp"
#include "swiftlet/io/missions/mission_frame.hpp"

namespace swiftlet::ground {

struct FleetMember {
  std::string name;                                     // in the domain
  Eigen::Vector2d start_ned = Eigen::Vector2d::Zero();  // m, on the ground
  std::filesystem::path vehicle_file, mission_file;
  // True: the mission is shifted by start_ned, as `swiftlet fly` does with several vehicles.
  bool mission_at_start = false;
  int priority = 1;  // 1 .. 100: a vehicle of a lower one makes way for one of a higher one
};

struct FleetFile {
  std::string name;
  std::string description;
  io::MissionFrame frame = io::MissionFrame::kNed;
  std::filesystem::path file, control_file, simulation_file;
  Ellipsoid safety;
  std::vector<FleetMember> vehicles;
};

constexpr std::size_t kMostFleetVehicles = 50;

// Both throw io::ConfigError with file, line, key, value and limit.
FleetFile load_fleet_file(const std::string& path);
FleetFile parse_fleet_file(std::string_view text, const std::string& file_name);

}  // namespace swiftlet::ground
