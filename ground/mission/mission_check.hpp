// Checks by the vehicle's model whether it can fly a mission, everywhere on the path, and how long it takes. All
// commands that check or fly a mission decide by this.
#pragma once

#include <limits>
#include <optional>
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
  // The battery's, in hover, until its voltage is at the low-battery threshold; null in JSON if it never runs empty.
  double endurance_s = std::numeric_limits<double>::infinity();

  bool feasible() const;
  // Why it is not feasible: the reason, or the demand that is furthest beyond its limit, with item, time and place, or that it
  // takes longer than the battery lasts. Empty if it is.
  std::string refusal() const;
};

struct CheckConditions {
  Eigen::Vector2d start_ned = Eigen::Vector2d::Zero();  // m, where the vehicle stands
  std::optional<double>
      supply_voltage_v;  // > 0, at which the rotors are checked; else the low-battery threshold
  // 0 .. 1: the share of the tilt limit, and of the range between least and greatest thrust at both of its ends, that is
  // kept free: the limits are so much tighter.
  double reserve = 0.0;
  std::optional<double> state_of_charge{};  // 0 .. 1, of the battery at the start; none: it never runs empty
};

// A dry run of the mission, and the demands on its path. Limits and fence: those of the settings, as tightened by the
// mission.
MissionCheck check_mission(const io::MissionFile& file, const plant::Vehicle& vehicle,
                           const control::ControlSettings& settings, const CheckConditions& conditions = {});

// What would make a mission feasible that is not, as sentences with the options of a command: the least time scale, and for
// samples that are noisy the least tolerance. Empty if neither does. path, options: of the file.
std::string advice(const io::MissionFile& file, const std::string& path, const io::FileOptions& options,
                   const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                   const CheckConditions& conditions = {});

// "kaylion cannot fly it: item 2 (trajectory): ...; slower by 1.4: --time-scale 1.4"; empty if it can.
std::string refusal_with_advice(const io::MissionFile& file, const std::string& path,
                                const io::FileOptions& options, const plant::Vehicle& vehicle,
                                const control::ControlSettings& settings, const MissionCheck& check,
                                const CheckConditions& conditions = {});

// check_table(): text for people, ends in a newline. check_json(): JSON, without a newline, of
//   mission, vehicle, control, feasible, reason, advice, duration_s, supply_voltage_v, endurance_s
//   items: kind, line, start_s, duration_s,
//     demands: demand, unit, value, limit, exceeded, time_s, position_ned
std::string check_table(const MissionCheck& check, const io::MissionFile& file, const std::string& vehicle);
std::string check_json(const MissionCheck& check, const io::MissionFile& file, const std::string& vehicle,
                       const std::string& control, const std::string& advice);

}  // namespace swiftlet::ground
