// Whether a vehicle can fly a mission, by its model, everywhere on the path.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/control/planning/feasibility.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/ground/mission/dry_run.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {

// Of one item: when it is flown, and the worst of each demand on its way; none where nothing moves.
struct ItemCheck {
  control::MissionItemKind kind = control::MissionItemKind::kWaypoint;
  int line = 0;  // in the file; 0 if that is not known
  double start_s = 0.0;
  double duration_s = 0.0;
  std::vector<control::WorstDemand> demands;  // time_s: since the mission's start
};

struct MissionCheck {
  std::string reason;  // the control service's, if it would not fly it to the end
  std::vector<ItemCheck> items;
  double duration_s = 0.0;
  double supply_voltage_v = 0.0;  // at which the rotors must do it

  bool feasible() const;
};

// At the voltage at which a flight is ended for a low battery, or another one above 0. Limits and fence:
// the settings', as the mission tightens them.
MissionCheck check_mission(const MissionFile& file, const MissionDryRun& dry_run,
                           const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                           double supply_voltage_v);

// For reading, ending in a newline; as JSON without one:
//   mission, vehicle, control, feasible, reason, duration_s, supply_voltage_v
//   items: kind, line, start_s, duration_s,
//     demands: demand, unit, value, limit, exceeded, time_s, position_ned
std::string check_table(const MissionCheck& check, const MissionFile& file, const std::string& vehicle);
std::string check_json(const MissionCheck& check, const MissionFile& file, const std::string& vehicle,
                       const std::string& control);

}  // namespace swiftlet::ground
