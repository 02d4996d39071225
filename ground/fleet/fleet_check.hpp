// Checks a fleet before take-off: each mission by its dry run, each pair of vehicles by their distance over the whole
// flight, starting and landing places included, and whether the monitor can keep late ones apart.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/ground/fleet/fleet_file.hpp"
#include "swiftlet/ground/fleet/fleet_monitor.hpp"
#include "swiftlet/ground/fleet/flight_path.hpp"
#include "swiftlet/ground/mission/mission_check.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {

struct FleetVehicle {
  FleetMember member;
  plant::Vehicle vehicle;
  io::FileOptions reading;  // of the mission file
  io::MissionFile mission;  // in the frame of the fleet
  MissionCheck check;
  FlightPath path;
  MonitoredVehicle monitored;  // by the monitor in flight
};

struct FleetPair {
  std::size_t a = 0, b = 0;  // indices of the vehicles
  Approach closest;
};

struct FleetCheck {
  FleetFile fleet;
  std::vector<FleetVehicle> vehicles;
  std::vector<FleetPair> pairs;  // by clearance, the closest first
  RightOfWay::Slack slack;       // the least, for vehicles that are late
  double needed_slack_s = 0.0;   // of the second vehicle
  double duration_s = 0.0;

  bool feasible() const { return refusal().empty(); }
  // Why the fleet must not fly, one sentence; empty if it may.
  std::string refusal() const;
};

// Reads the files that the fleet names and checks the flight. Throws io::ConfigError for invalid files, and for a
// mission that does not begin with a take-off or does not end with a landing.
FleetCheck check_fleet(const FleetFile& fleet);

// "cf1 and cf2 come too near: 0.12 m apart at 7.32 s ..."; how near the two come, and how far they must be apart.
std::string describe(const FleetCheck& check, const FleetPair& pair);

// The monitor of this fleet in flight.
FleetMonitor monitor_of(const FleetCheck& check);

// check_table(): text for people, ends in a newline. check_json(): JSON, without a newline, of
//   fleet, feasible, reason, duration_s, safety: radius_xy_m, radius_z_m
//   vehicles: name, vehicle, mission, priority, start_ned_m, end_ned_m, feasible, reason, duration_s
//   slack_s (null without a conflict of late vehicles), needed_slack_s
//   pairs: a, b, clearance, distance_m, time_s, a_ned_m, b_ned_m
std::string check_table(const FleetCheck& check);
std::string check_json(const FleetCheck& check);

}  // namespace swiftlet::ground
