#include "swiftlet/ground/fleet/fleet_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/control/guidance/time_scaling.hpp"
#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/ground/mission/shifted_mission.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/plant/model/airframe.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kTouching = 1.0 - 2e-5;  // the bound of Approach::clearance
constexpr std::size_t kListedPairs = 10;
constexpr double kLateShare =
    2.0 / 3.0;  // of the safety ellipsoid, that no other one's touches when vehicles are late
constexpr double kReaction_s = 0.15;  // from an estimate until the vehicle begins to stop
constexpr double kLeastStop_s = 0.5;  // of control/guidance: shortest change of the time scaling

// Mission files and QGroundControl plans name their frame.
io::FileOptions reading_of(const FleetMember& member, io::MissionFrame frame) {
  io::FileOptions reading;
  const io::MissionFormat format = io::read_source(member.mission_file).format;
  if (format != io::MissionFormat::kYaml && format != io::MissionFormat::kQGroundControlPlan)
    reading.frame = frame;
  return reading;
}

io::MissionFile mission_of(const FleetMember& member, const io::FileOptions& reading,
                           const control::Limits& limits) {
  io::MissionFile file = io::load_mission_file(member.mission_file, limits, reading);
  if (member.mission_at_start) file.mission = shifted(std::move(file.mission), member.start_ned, limits);
  const auto refuse = [&](const std::string& reason) {
    throw io::ConfigError(member.mission_file.string(), 0, "", "flown by " + member.name + ": " + reason);
  };
  const control::Outcome outcome = control::check(file.mission, limits);
  if (!outcome.accepted) refuse(outcome.reason);
  if (!file.takes_off() || !file.lands())
    refuse("must begin with a takeoff and end with a land: a fleet starts and ends on the ground");
  return file;
}

// While it slows to a stop, path time goes on by half of the change's duration.
double stop_s(const FlightPath& path, const control::Limits& limits) {
  return kReaction_s + 0.5 * control::clock_change_duration(greatest_speed(path),
                                                            limits.max_reference_acceleration,
                                                            limits.max_reference_jerk, kLeastStop_s);
}

FleetVehicle vehicle_of(const FleetMember& member, const FleetFile& fleet,
                        const control::ControlSettings& control) {
  plant::Vehicle vehicle = io::load_vehicle(member.vehicle_file);
  if (const double width_m = plant::width(vehicle); 2.0 * fleet.safety.radius_xy_m < width_m) {
    throw io::ConfigError(
        fleet.file.string(), 0, "safety.radius_xy_m",
        fmt::format("is {:g} m, must be at least {:.2f} m: {}, a {}, is up to {:.2f} m wide",
                    fleet.safety.radius_xy_m, 0.5 * width_m, member.name, vehicle.name, width_m));
  }
  const io::FileOptions reading = reading_of(member, fleet.frame);
  io::MissionFile mission = mission_of(member, reading, control.limits);
  MissionCheck check = check_mission(mission, vehicle, control, {member.start_ned, {}, 0.0, 1.0});
  FlightPath path =
      FlightPath::of(dry_run(mission.mission, control, member.start_ned), member.start_ned, mission.lands());
  const Ellipsoid around{std::max(kLateShare * fleet.safety.radius_xy_m, 0.5 * plant::width(vehicle)),
                         kLateShare * fleet.safety.radius_z_m};
  const control::Limits limits = control::tightened(control.limits, mission.mission.bounds);
  const double lands_s = check.items.empty() ? 0.0 : check.items.back().start_s;
  const Eigen::AlignedBox2d room(limits.fence_min_ned.head<2>(), limits.fence_max_ned.head<2>());
  MonitoredVehicle monitored{{path, around, lands_s}, stop_s(path, limits), member.priority, room};
  return {member,          std::move(vehicle),  reading, std::move(mission), std::move(check),
          std::move(path), std::move(monitored)};
}

std::string place(const Eigen::Vector3d& p) {
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", p.x(), p.y(), p.z());
}

nlohmann::ordered_json json_of(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

}  // namespace

std::string FleetCheck::refusal() const {
  for (const FleetVehicle& one : vehicles) {
    if (!one.check.feasible())
      return fmt::format("{} cannot fly {}: {}", one.member.name, one.mission.name, one.check.refusal());
  }
  if (!pairs.empty() && pairs.front().closest.clearance < kTouching) return describe(*this, pairs.front());
  if (slack.slack_s >= needed_slack_s) return "";
  return fmt::format(
      "{} comes to where {} was at {:.2f} s, {:.2f} s after it: if {} were late, {} could not stop in time, "
      "for which "
      "it needs {:.2f} s",
      vehicles[slack.second].member.name, vehicles[slack.first].member.name, slack.at_s, slack.slack_s,
      vehicles[slack.first].member.name, vehicles[slack.second].member.name, needed_slack_s);
}

FleetCheck check_fleet(const FleetFile& fleet) {
  FleetCheck check;
  check.fleet = fleet;
  const control::ControlSettings control = io::load_control_settings(fleet.control_file);
  for (const FleetMember& member : fleet.vehicles) {
    check.vehicles.push_back(vehicle_of(member, fleet, control));
    check.duration_s = std::max(check.duration_s, check.vehicles.back().path.duration_s());
  }
  for (std::size_t b = 0; b < check.vehicles.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      check.pairs.push_back(
          {a, b,
           closest_approach(check.vehicles[a].path, fleet.safety, check.vehicles[b].path, fleet.safety)});
    }
  }
  std::sort(check.pairs.begin(), check.pairs.end(), [](const FleetPair& one, const FleetPair& other) {
    return one.closest.clearance < other.closest.clearance;
  });
  const FleetMonitor monitor = monitor_of(check);
  check.slack = monitor.least_slack();
  check.needed_slack_s = monitor.needed_slack_s(check.slack.second);
  return check;
}

FleetMonitor monitor_of(const FleetCheck& check) {
  std::vector<MonitoredVehicle> vehicles;
  for (const FleetVehicle& one : check.vehicles) vehicles.push_back(one.monitored);
  return FleetMonitor(std::move(vehicles));
}

std::string describe(const FleetCheck& check, const FleetPair& pair) {
  const Approach& closest = pair.closest;
  const Eigen::Vector3d apart = closest.b_ned - closest.a_ned;
  const Ellipsoid& safety = check.fleet.safety;
  return fmt::format(
      "{} and {} {}: {:.3f} m apart at {:.2f} s ({:.3f} m across, {:.3f} m in height), at {} and {} m NED; "
      "they must be {:.2f} m apart across, or {:.2f} m in height, or between the two on an ellipsoid",
      check.vehicles[pair.a].member.name, check.vehicles[pair.b].member.name,
      closest.clearance >= kTouching ? "are closest" : "come too near", apart.norm(), closest.time_s,
      apart.head<2>().norm(), std::abs(apart.z()), place(closest.a_ned), place(closest.b_ned),
      2.0 * safety.radius_xy_m, 2.0 * safety.radius_z_m);
}

std::string check_table(const FleetCheck& check) {
  const FleetFile& fleet = check.fleet;
  std::string text =
      fmt::format("{}{}\n\n{:<10} {:<12} {:<14} {:>8} {:>8}  {:<16} {}\n", fleet.name,
                  fleet.description.empty() ? "" : ": " + fleet.description, "vehicle", "model", "mission",
                  "priority", "lasts s", "starts at m NED", "lands at m NED");
  for (const FleetVehicle& one : check.vehicles) {
    const Eigen::Vector3d start = one.path.at(0.0);
    const Eigen::Vector3d end = one.path.at(one.path.duration_s());
    text += fmt::format("{:<10} {:<12} {:<14} {:>8} {:>8.2f}  {:<16} {}{}\n", one.member.name,
                        one.vehicle.name, one.mission.name, one.member.priority, one.check.duration_s,
                        fmt::format("({:.2f}, {:.2f})", start.x(), start.y()),
                        fmt::format("({:.2f}, {:.2f})", end.x(), end.y()),
                        one.check.feasible() ? "" : "  cannot fly it");
  }
  if (!check.pairs.empty()) {
    text += fmt::format("\n{:<21} {:>9} {:>10} {:>8}\n", "closest pairs", "clearance", "distance m", "at s");
  }
  for (std::size_t i = 0; i < std::min(check.pairs.size(), kListedPairs); ++i) {
    const FleetPair& pair = check.pairs[i];
    text += fmt::format("{:<10} {:<10} {:>9.2f} {:>10.3f} {:>8.2f}{}\n", check.vehicles[pair.a].member.name,
                        check.vehicles[pair.b].member.name, pair.closest.clearance,
                        (pair.closest.b_ned - pair.closest.a_ned).norm(), pair.closest.time_s,
                        pair.closest.clearance >= kTouching ? "" : "  too near");
  }
  const std::string refusal = check.refusal();
  text += "\n";
  if (!refusal.empty()) return text + fleet.name + " cannot be flown: " + refusal + "\n";
  return text +
         fmt::format("{} can be flown in {:.1f} s{}\n", fleet.name, check.duration_s,
                     check.pairs.empty() ? "" : "; " + describe(check, check.pairs.front())) +
         (std::isfinite(check.slack.slack_s)
              ? fmt::format("late vehicles: {} comes to where {} was {:.2f} s after it, at {:.2f} s, and "
                            "needs {:.2f} s "
                            "to stop\n",
                            check.vehicles[check.slack.second].member.name,
                            check.vehicles[check.slack.first].member.name, check.slack.slack_s,
                            check.slack.at_s, check.needed_slack_s)
              : "");
}

std::string check_json(const FleetCheck& check) {
  const std::string refusal = check.refusal();
  nlohmann::ordered_json vehicles = nlohmann::ordered_json::array();
  for (const FleetVehicle& one : check.vehicles) {
    vehicles.push_back({{"name", one.member.name},
                        {"vehicle", one.vehicle.name},
                        {"mission", one.mission.name},
                        {"priority", one.member.priority},
                        {"start_ned_m", json_of(one.path.at(0.0))},
                        {"end_ned_m", json_of(one.path.at(one.path.duration_s()))},
                        {"feasible", one.check.feasible()},
                        {"reason", one.check.refusal()},
                        {"duration_s", one.check.duration_s}});
  }
  nlohmann::ordered_json pairs = nlohmann::ordered_json::array();
  for (const FleetPair& pair : check.pairs) {
    const Approach& closest = pair.closest;
    pairs.push_back({{"a", check.vehicles[pair.a].member.name},
                     {"b", check.vehicles[pair.b].member.name},
                     {"clearance", closest.clearance},
                     {"distance_m", (closest.b_ned - closest.a_ned).norm()},
                     {"time_s", closest.time_s},
                     {"a_ned_m", json_of(closest.a_ned)},
                     {"b_ned_m", json_of(closest.b_ned)}});
  }
  const nlohmann::ordered_json json = {
      {"fleet", check.fleet.name},
      {"feasible", refusal.empty()},
      {"reason", refusal},
      {"duration_s", check.duration_s},
      {"safety",
       {{"radius_xy_m", check.fleet.safety.radius_xy_m}, {"radius_z_m", check.fleet.safety.radius_z_m}}},
      {"slack_s", std::isfinite(check.slack.slack_s) ? nlohmann::ordered_json(check.slack.slack_s)
                                                     : nlohmann::ordered_json()},
      {"needed_slack_s", check.needed_slack_s},
      {"vehicles", vehicles},
      {"pairs", pairs}};
  return io::json_text(json);
}

}  // namespace swiftlet::ground
