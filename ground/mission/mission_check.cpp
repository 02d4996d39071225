#include "swiftlet/ground/mission/mission_check.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/control/design/battery_limits.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/math/angles.hpp"
#include "swiftlet/plant/model/endurance.hpp"

namespace swiftlet::ground {
namespace {

using control::Demand;
using control::WorstDemand;

constexpr int kMaxListed = 20;  // exceeded limits listed one by one

const WorstDemand* find(const ItemCheck& item, Demand demand) {
  const auto found = std::find_if(item.demands.begin(), item.demands.end(),
                                  [demand](const WorstDemand& worst) { return worst.demand == demand; });
  return found == item.demands.end() ? nullptr : &*found;
}

// Tightens the limits of tilt and thrust.
void keep_reserve(std::vector<WorstDemand>& demands, double reserve) {
  const auto of = [&demands](Demand demand) -> double& {
    return demands[static_cast<std::size_t>(demand)].limit;
  };
  of(Demand::kTilt) *= 1.0 - reserve;
  of(Demand::kThrust) *= 1.0 - reserve;
  const double range = of(Demand::kRotorMost) - of(Demand::kRotorLeast);
  of(Demand::kRotorLeast) += reserve * range;
  of(Demand::kRotorMost) -= reserve * range;
}

// The worst demands on the legs of an item, with times since the start of the mission, holds included.
std::vector<WorstDemand> demands_on(const std::vector<DryRunLeg>& legs, const plant::Vehicle& vehicle,
                                    const control::Limits& limits, double supply_voltage_v, double reserve) {
  if (legs.empty()) return {};
  std::vector<control::PolynomialSegment> segments;
  std::vector<double> begins_s;
  double at_s = 0.0;
  for (const DryRunLeg& leg : legs) {
    segments.push_back(leg.segment);
    begins_s.push_back(at_s);
    at_s += leg.segment.duration_s;
  }
  std::vector<WorstDemand> demands = control::worst_demands(vehicle, limits, supply_voltage_v, segments);
  keep_reserve(demands, reserve);
  for (WorstDemand& worst : demands) worst.time_s += legs[worst.segment].start_s - begins_s[worst.segment];
  return demands;
}

// The value as a share of its limit; 1: at the limit.
double use_of(const WorstDemand& worst) {
  const bool least = worst.demand == Demand::kLift || worst.demand == Demand::kRotorLeast;
  return least ? worst.limit / std::max(worst.value, 1e-9) : worst.value / worst.limit;
}

std::string place_of(const WorstDemand& worst) {
  const Eigen::Vector3d& p = worst.position_ned;
  return fmt::format("at {:.2f} s, ({:.2f}, {:.2f}, {:.2f}) m NED", worst.time_s, p.x(), p.y(), p.z());
}

std::string value_of(const WorstDemand& worst) {
  if (worst.demand == Demand::kFence) return fmt::format("{:.3f} m beyond the fence", worst.value);
  const bool least = worst.demand == Demand::kLift || worst.demand == Demand::kRotorLeast;
  const char* const unit = control::unit_of(worst.demand);
  return fmt::format("{} is {:.3f} {}, the limit is {}{:.3f} {}", control::to_string(worst.demand),
                     worst.value, unit, least ? "at least " : "", worst.limit, unit);
}

std::string name_of(const ItemCheck& item, std::size_t index) {
  const std::string line = item.line > 0 ? fmt::format(", line {}", item.line) : "";
  return fmt::format("item {} ({}{})", index + 1, control::to_string(item.kind), line.c_str());
}

std::string row_of(const ItemCheck& item, std::size_t index) {
  std::string row =
      fmt::format("{:5}  {:<10} {:>5} {:9.2f} {:8.2f}", index + 1, control::to_string(item.kind),
                  item.line > 0 ? std::to_string(item.line).c_str() : "", item.start_s, item.duration_s);
  if (item.demands.empty()) return row + "\n";
  const bool exceeded = std::any_of(item.demands.begin(), item.demands.end(),
                                    [](const WorstDemand& worst) { return worst.exceeded(); });
  const WorstDemand& rotor = *find(item, Demand::kRotorMost);
  return row + fmt::format(" {:9.2f} {:9.2f} {:9.1f} {:9.1f}{}\n", find(item, Demand::kSpeed)->value,
                           find(item, Demand::kAcceleration)->value,
                           find(item, Demand::kTilt)->value * math::kDegPerRad, 100.0 * use_of(rotor),
                           exceeded ? "  !" : "");
}

std::string limits_row(const ItemCheck& item) {
  return fmt::format("{:<42} {:9.2f} {:9.2f} {:9.1f} {:9.1f}\n", "       limit",
                     find(item, Demand::kSpeed)->limit, find(item, Demand::kAcceleration)->limit,
                     find(item, Demand::kTilt)->limit * math::kDegPerRad, 100.0);
}

// The demand closest to its limit. Leaves out the fence, for which a share is not defined.
std::string closest_to_limit(const MissionCheck& check) {
  const WorstDemand* nearest = nullptr;
  std::string where;
  for (std::size_t i = 0; i < check.items.size(); ++i) {
    for (const WorstDemand& worst : check.items[i].demands) {
      if (worst.demand == Demand::kFence || (nearest != nullptr && use_of(worst) <= use_of(*nearest)))
        continue;
      nearest = &worst;
      where = name_of(check.items[i], i);
    }
  }
  if (nearest == nullptr) return "";
  return "closest to its limit: " + where + ": " + value_of(*nearest) + ": " + place_of(*nearest) + "\n";
}

std::string exceeded_of(const MissionCheck& check) {
  std::string text;
  int count = 0;
  for (std::size_t i = 0; i < check.items.size(); ++i) {
    for (const WorstDemand& worst : check.items[i].demands) {
      if (!worst.exceeded()) continue;
      if (++count <= kMaxListed)
        text += name_of(check.items[i], i) + ": " + value_of(worst) + ": " + place_of(worst) + "\n";
    }
  }
  if (count > kMaxListed) text += fmt::format("and {} more\n", count - kMaxListed);
  return text;
}

nlohmann::ordered_json json_of(const WorstDemand& worst) {
  const Eigen::Vector3d& p = worst.position_ned;
  return {{"demand", control::to_string(worst.demand)},
          {"unit", control::unit_of(worst.demand)},
          {"value", worst.value},
          {"limit", worst.limit},
          {"exceeded", worst.exceeded()},
          {"time_s", worst.time_s},
          {"position_ned", {p.x(), p.y(), p.z()}}};
}

std::string outlasted(const MissionCheck& check) {
  return fmt::format("it takes {:.1f} s, longer than the battery lasts: {:.0f} s of hover", check.duration_s,
                     check.endurance_s);
}

}  // namespace

bool MissionCheck::feasible() const {
  return reason.empty() && duration_s <= endurance_s &&
         std::all_of(items.begin(), items.end(), [](const ItemCheck& item) {
           return std::none_of(item.demands.begin(), item.demands.end(),
                               [](const WorstDemand& worst) { return worst.exceeded(); });
         });
}

std::string MissionCheck::refusal() const {
  if (!reason.empty()) return "the control service would not complete it: " + reason;
  const WorstDemand* furthest = nullptr;
  std::string where;
  for (std::size_t i = 0; i < items.size(); ++i) {
    for (const WorstDemand& worst : items[i].demands) {
      if (!worst.exceeded() || (furthest != nullptr && use_of(worst) <= use_of(*furthest))) continue;
      furthest = &worst;
      where = name_of(items[i], i);
    }
  }
  if (furthest == nullptr) return duration_s <= endurance_s ? "" : outlasted(*this);
  return where + ": " + value_of(*furthest) + ": " + place_of(*furthest);
}

MissionCheck check_mission(const io::MissionFile& file, const plant::Vehicle& vehicle,
                           const control::ControlSettings& settings, const CheckConditions& conditions) {
  const MissionDryRun dry_run = ground::dry_run(file.mission, settings, conditions.start_ned);
  const double least_voltage_v = control::with_battery_limits(settings.failsafe, vehicle).low_battery_voltage;
  const double supply_voltage_v = conditions.supply_voltage_v.value_or(least_voltage_v);
  const control::Limits limits = control::tightened(settings.limits, file.mission.bounds);
  MissionCheck check;
  check.reason = dry_run.completed ? "" : dry_run.reason;
  check.duration_s = dry_run.duration_s;
  check.supply_voltage_v = supply_voltage_v;
  if (conditions.state_of_charge)
    check.endurance_s = plant::hover_endurance_s(vehicle, *conditions.state_of_charge, least_voltage_v);
  for (std::size_t i = 0; i < dry_run.item_starts_s.size(); ++i) {
    const bool last = i + 1 == dry_run.item_starts_s.size();
    const double end_s = last ? dry_run.duration_s : dry_run.item_starts_s[i + 1];
    std::vector<DryRunLeg> legs;
    std::copy_if(dry_run.legs.begin(), dry_run.legs.end(), std::back_inserter(legs),
                 [i](const DryRunLeg& leg) { return leg.item == i; });
    check.items.push_back({file.mission.items[i].kind, i < file.lines.size() ? file.lines[i] : 0,
                           dry_run.item_starts_s[i], end_s - dry_run.item_starts_s[i],
                           demands_on(legs, vehicle, limits, supply_voltage_v, conditions.reserve)});
  }
  return check;
}

std::string check_table(const MissionCheck& check, const io::MissionFile& file, const std::string& vehicle) {
  std::string text = file.name + (file.description.empty() ? "" : ": " + file.description) + "\n\n" +
                     fmt::format("{:>5}  {:<10} {:>5} {:>9} {:>8} {:>9} {:>9} {:>9} {:>9}\n", "item", "kind",
                                 "line", "from s", "lasts s", "m/s", "m/s^2", "tilt deg", "rotor %");
  const ItemCheck* moving = nullptr;
  for (std::size_t i = 0; i < check.items.size(); ++i) {
    text += row_of(check.items[i], i);
    if (!check.items[i].demands.empty()) moving = &check.items[i];
  }
  if (moving != nullptr) text += limits_row(*moving);
  text += "\n" + closest_to_limit(check) + exceeded_of(check);
  if (!check.reason.empty())
    return text + "the control service would not complete the mission: " + check.reason + "\n";
  if (check.duration_s > check.endurance_s) text += outlasted(check) + "\n";
  const std::string endurance = std::isfinite(check.endurance_s)
                                    ? fmt::format(", which lasts {:.0f} s of hover", check.endurance_s)
                                    : "";
  return text + fmt::format("{} {} fly the mission: {:.1f} s, with a battery down to {:.2f} V{}\n", vehicle,
                            check.feasible() ? "can" : "cannot", check.duration_s, check.supply_voltage_v,
                            endurance);
}

std::string check_json(const MissionCheck& check, const io::MissionFile& file, const std::string& vehicle,
                       const std::string& control, const std::string& advice) {
  nlohmann::ordered_json json = {{"mission", file.name},
                                 {"vehicle", vehicle},
                                 {"control", control},
                                 {"feasible", check.feasible()},
                                 {"reason", check.reason},
                                 {"advice", advice},
                                 {"duration_s", check.duration_s},
                                 {"supply_voltage_v", check.supply_voltage_v},
                                 {"endurance_s", check.endurance_s}};
  json["items"] = nlohmann::ordered_json::array();
  for (const ItemCheck& item : check.items) {
    nlohmann::ordered_json demands = nlohmann::ordered_json::array();
    for (const WorstDemand& worst : item.demands) demands.push_back(json_of(worst));
    json["items"].push_back({{"kind", control::to_string(item.kind)},
                             {"line", item.line},
                             {"start_s", item.start_s},
                             {"duration_s", item.duration_s},
                             {"demands", std::move(demands)}});
  }
  return io::json_text(json, 2);
}

}  // namespace swiftlet::ground
