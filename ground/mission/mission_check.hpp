// Checks by the vehicle's model whether it can fly a mission, everywhere on the path.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/control/planning/feasibility.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/ground/mission/dry_run.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {

// One item: when it is flown, and the worst value of each demand on its path; none if the item does not move.
struct ItemCheck {
  control::MissionItemKind kind = control::MissionItemKind::kWaypoint;
  int line = 0;  // in the file; 0 if unknown
  double start_s = 0.0;
  double duration_s = 0.0;
  std::vector<control::WorstDemand> demands;  // time_s: since the start of the mission
};

struct MissionCheck {
  std::string reason;  // why the control service would not complete it; else empty
  std::vector<ItemCheck> items;
  double duration_s = 0.0;
  double supply_voltage_v = 0.0;  // at which the rotors are checked

  bool feasible() const;
};

// supply_voltage_v: > 0, usually the low-battery threshold. Limits and fence: those of the settings, as
// tightened by the mission.
MissionCheck check_mission(const MissionFile& file, const MissionDryRun& dry_run,
                           const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                           double supply_voltage_v);

// check_table(): text for people, ends in a newline. check_json(): JSON, without a newline, of
//   mission, vehicle, control, feasible, reason, duration_s, supply_voltage_v
//   items: kind, line, start_s, duration_s,
//     demands: demand, unit, value, limit, exceeded, time_s, position_ned
std::string check_table(const MissionCheck& check, const MissionFile& file, const std::string& vehicle);
std::string check_json(const MissionCheck& check, const MissionFile& file, const std::string& vehicle,
                       const std::string& control);

}  // namespace swiftlet::ground
