#include "swiftlet/ground/mission/mission_page.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/core.h>

#include "swiftlet/analysis/pages/flight_page.hpp"
#include "swiftlet/math/angles.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {
namespace {

using Eigen::Vector3d;

constexpr double kPageStep_s = 0.02;
constexpr std::array<const char*, 3> kAxes = {"north", "east", "down"};

// The attitude whose thrust gives the acceleration, with the nose at the yaw.
Eigen::Quaterniond attitude_of(const control::Reference& at) {
  const Vector3d down = (Vector3d(0.0, 0.0, plant::kGravity) - at.acceleration_ned).normalized();
  const Vector3d nose(std::cos(at.yaw_rad), std::sin(at.yaw_rad), 0.0);
  const Vector3d right = down.cross(nose).normalized();
  Eigen::Matrix3d axes;
  axes << right.cross(down), right, down;
  return Eigen::Quaterniond(axes);
}

void add_row(pages::SignalTable& path, double time_s, const control::Reference& at) {
  const auto add = [&](const std::string& name, double value) { path.signals[name].push_back(value); };
  path.time_s.push_back(time_s);
  for (int i = 0; i < 3; ++i) {
    add(kAxes.at(i), at.position_ned[i]);
    add(std::string("v_") + kAxes.at(i), at.velocity_ned[i]);
  }
  add("speed", at.velocity_ned.norm());
  add("acceleration", at.acceleration_ned.norm());
  const Vector3d thrust = at.acceleration_ned - Vector3d(0.0, 0.0, plant::kGravity);
  add("tilt", math::kDegPerRad * std::atan2(thrust.head<2>().norm(), -thrust.z()));
  const Eigen::Quaterniond q = attitude_of(at);
  const std::array<double, 4> components = {q.w(), q.x(), q.y(), q.z()};
  for (std::size_t i = 0; i < components.size(); ++i) add("q[" + std::to_string(i) + "]", components[i]);
}

pages::SignalTable path_of(const MissionDryRun& dry_run) {
  pages::SignalTable path;
  for (const DryRunLeg& leg : dry_run.legs) {
    const double steps = std::max(1.0, std::ceil(leg.segment.duration_s / kPageStep_s));
    for (double i = 0.0; i <= steps; i += 1.0) {
      const double t_s = leg.segment.duration_s * i / steps;
      add_row(path, leg.start_s + t_s, control::evaluate(leg.segment, t_s));
    }
  }
  return path;
}

}  // namespace

std::string mission_page(const io::MissionFile& file, const MissionDryRun& dry_run,
                         const control::Limits& settings) {
  const control::Limits limits = control::tightened(settings, file.mission.bounds);
  pages::FlightLog flight;
  flight.name = file.name;
  flight.tables["path"] = path_of(dry_run);
  flight.end_s = std::max(dry_run.duration_s, flight.tables["path"].time_s.back());
  flight.tables["limits"] = {
      {0.0, flight.end_s},
      {{"speed", {limits.max_speed, limits.max_speed}},
       {"acceleration", {limits.max_acceleration, limits.max_acceleration}},
       {"tilt", {math::kDegPerRad * limits.max_tilt_rad, math::kDegPerRad * limits.max_tilt_rad}}}};
  flight.fence.emplace();
  for (int i = 0; i < 3; ++i) {
    flight.fence->min_ned.at(i) = limits.fence_min_ned[i];
    flight.fence->max_ned.at(i) = limits.fence_max_ned[i];
  }
  flight.modes = {{0.0, "mission"}};
  for (std::size_t i = 0; i < dry_run.item_starts_s.size(); ++i)
    flight.events.push_back({dry_run.item_starts_s[i], "mission",
                             fmt::format("item {} of {}", i + 1, file.mission.items.size()), false});
  if (!dry_run.completed) flight.events.push_back({flight.end_s, "mission", dry_run.reason, true});
  if (!file.description.empty()) flight.summary.emplace_back("description", file.description);
  flight.summary.emplace_back("items", std::to_string(file.mission.items.size()));
  flight.summary.emplace_back("duration", fmt::format("{:.1f} s", dry_run.duration_s));
  flight.summary.emplace_back("result", dry_run.completed ? "completed" : dry_run.reason);
  return pages::flight_page("Mission " + file.name,
                            "The dry run of the mission, with an ideal vehicle. Time counts from its start.",
                            {flight});
}

}  // namespace swiftlet::ground
