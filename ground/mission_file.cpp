#include "ground/mission_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "control/trajectory/polynomial.hpp"
#include "ground/formats/mission_format.hpp"
#include "services/runtime/config.hpp"
#include "services/runtime/text_file.hpp"

namespace swiftlet::ground {
namespace {

using control::MissionItem;
using control::MissionItemKind;
using runtime::ConfigNode;

constexpr double kPi = 3.14159265358979323846;
constexpr double kLongestHoldS = 3600.0;
constexpr double kLargestToleranceM = 10.0;
constexpr int kMaxName = 64;

enum class Frame { kNed, kEnu };

std::string text_of(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

Eigen::Vector3d ned_from(Frame frame, const Eigen::Vector3d& position) {
  return frame == Frame::kNed ? position : Eigen::Vector3d(position.y(), position.x(), -position.z());
}

// ENU yaw is counter-clockwise from east, NED yaw clockwise from north.
double ned_yaw_from(Frame frame, double yaw) {
  return frame == Frame::kNed ? yaw : std::remainder(kPi / 2 - yaw, 2 * kPi);
}

void demand_inside_fence(const ConfigNode& node, const Eigen::Vector3d& position_ned,
                         const control::Limits& limits) {
  constexpr const char* kAxes[] = {"north", "east", "down"};
  for (int axis = 0; axis < 3; ++axis) {
    const double value = position_ned[axis];
    const double low = limits.fence_min_ned[axis];
    const double high = limits.fence_max_ned[axis];
    if (value >= low && value <= high) continue;
    node.fail(std::string(kAxes[axis]) + " is " + text_of(value) + " m, must be inside the fence, " +
              text_of(low) + " to " + text_of(high) + " m");
  }
}

double read_speed(const ConfigNode& node, const control::Limits& limits) {
  const ConfigNode speed = node.at("speed_m_s");
  return speed.number({0.0, limits.max_speed, true, false});
}

double read_hold(const ConfigNode& node) {
  const auto hold = node.find("hold_s");
  return hold ? hold->number(runtime::between(0.0, kLongestHoldS)) : 0.0;
}

MissionItem read_takeoff(const ConfigNode& node, const control::Limits& limits) {
  MissionItem item;
  item.kind = MissionItemKind::kTakeoff;
  const ConfigNode height = node.at("height_m");
  item.position_ned.z() = -height.number(runtime::above(0.0));
  demand_inside_fence(height, item.position_ned, limits);
  item.speed = read_speed(node, limits);
  item.hold_s = read_hold(node);
  return item;
}

MissionItem read_waypoint(const ConfigNode& node, Frame frame, const control::Limits& limits) {
  MissionItem item;
  item.kind = MissionItemKind::kWaypoint;
  const ConfigNode position = node.at("position_m");
  item.position_ned = ned_from(frame, position.vector3());
  demand_inside_fence(position, item.position_ned, limits);
  if (const auto yaw = node.find("yaw_rad")) {
    item.yaw_free = false;
    item.yaw_rad = ned_yaw_from(frame, yaw->number(runtime::between(-kPi, kPi)));
  }
  item.speed = read_speed(node, limits);
  item.hold_s = read_hold(node);
  return item;
}

MissionItem read_land(const ConfigNode& node, const control::Limits& limits) {
  MissionItem item;
  item.kind = MissionItemKind::kLand;
  item.speed = read_speed(node, limits);
  return item;
}

MissionItem read_item(const ConfigNode& node, Frame frame, const control::Limits& limits) {
  const auto kind = node.at("kind").choice<MissionItemKind>({{"takeoff", MissionItemKind::kTakeoff},
                                                             {"waypoint", MissionItemKind::kWaypoint},
                                                             {"land", MissionItemKind::kLand}});
  switch (kind) {
    case MissionItemKind::kTakeoff:
      return read_takeoff(node, limits);
    case MissionItemKind::kWaypoint:
      return read_waypoint(node, frame, limits);
    case MissionItemKind::kLand:
      return read_land(node, limits);
    case MissionItemKind::kTrajectory:
      break;
  }
  node.fail("is of no known kind");
}

MissionFile read_mission(const ConfigNode& root, const control::Limits& limits) {
  MissionFile file;
  const auto name = root.find("name");
  file.name = name ? name->text() : std::filesystem::path(root.file()).stem().string();
  if (name && (file.name.size() > kMaxName || file.name.find('/') != std::string::npos)) {
    name->fail("must be at most " + std::to_string(kMaxName) + " characters and hold no /");
  }
  if (const auto description = root.find("description")) file.description = description->text();
  const Frame frame = root.at("frame").choice<Frame>({{"ned", Frame::kNed}, {"enu", Frame::kEnu}});
  file.tolerance_m = root.at("tolerance_m").number({0.0, kLargestToleranceM, true, false});

  const std::vector<ConfigNode> items = root.at("items").items(1, control::kMaxMissionItems);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const MissionItem item = read_item(items[i], frame, limits);
    if (item.kind == MissionItemKind::kTakeoff && i > 0)
      items[i].fail("is a takeoff, which must be the first item");
    if (item.kind == MissionItemKind::kLand && i + 1 < items.size())
      items[i].fail("is a land, which must be the last item");
    file.mission.items.push_back(item);
  }
  root.reject_unknown_keys();
  return file;
}

Eigen::Vector3d start_of(const control::Mission& mission, const MissionItem& trajectory) {
  return control::evaluate(mission.segments[trajectory.first_segment], 0.0).position_ned;
}

}  // namespace

bool MissionFile::takes_off() const {
  return !mission.items.empty() && mission.items.front().kind == MissionItemKind::kTakeoff;
}

bool MissionFile::lands() const {
  return !mission.items.empty() && mission.items.back().kind == MissionItemKind::kLand;
}

MissionFile load_mission_file(const std::string& path, const control::Limits& limits) {
  const std::string text = runtime::read_text_file(path);
  switch (detect_format(text, path)) {
    case MissionFormat::kYaml:
      return parse_mission_file(text, path, limits);
    case MissionFormat::kPolynomialCsv:
      return parse_polynomial_csv(text, path, limits);
    case MissionFormat::kSampledCsv:
      return parse_sampled_csv(text, path, limits);
    case MissionFormat::kWaypointCsv:
      return parse_waypoint_csv(text, path, limits);
    case MissionFormat::kQGroundControlPlan:
      return parse_qgroundcontrol_plan(text, path, limits);
  }
  throw std::logic_error("a format that is not read");
}

MissionFile parse_mission_file(const std::string& text, const std::string& file_name,
                               const control::Limits& limits) {
  return read_mission(runtime::parse_config(text, file_name), limits);
}

double planned_duration_s(const control::Mission& mission, const control::Limits& limits) {
  double duration_s = 0.0;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  double yaw = 0.0;
  for (const MissionItem& item : mission.items) {
    Eigen::Vector3d to = item.position_ned;
    if (item.kind == MissionItemKind::kTakeoff) to = {at.x(), at.y(), item.position_ned.z()};
    if (item.kind == MissionItemKind::kLand) to = {at.x(), at.y(), 0.0};
    if (item.kind == MissionItemKind::kTrajectory) to = start_of(mission, item);
    const double distance = (to - at).norm();
    const double move_s =
        item.kind == MissionItemKind::kTrajectory
            ? control::septic_duration(distance, item.speed, limits.max_reference_acceleration,
                                       limits.max_reference_jerk)
            : control::minimum_jerk_duration(distance, item.speed, limits.max_reference_acceleration,
                                             limits.max_reference_jerk);
    double turn_s = 0.0;
    if (item.kind == MissionItemKind::kWaypoint && !item.yaw_free) {
      turn_s = 15.0 / 8.0 * std::abs(std::remainder(item.yaw_rad - yaw, 2 * kPi)) / limits.max_yaw_rate;
      yaw = item.yaw_rad;
    }
    duration_s += std::max(move_s, turn_s) + item.hold_s;
    at = to;
    if (item.kind != MissionItemKind::kTrajectory) continue;
    for (std::uint32_t i = 0; i < item.segment_count; ++i) {
      const control::PolynomialSegment& segment = mission.segments[item.first_segment + i];
      duration_s += segment.duration_s;
      const control::Reference end = control::evaluate(segment, segment.duration_s);
      at = end.position_ned;
      yaw = end.yaw_rad;
    }
  }
  return duration_s;
}

const char* to_string(MissionItemKind kind) {
  switch (kind) {
    case MissionItemKind::kTakeoff:
      return "takeoff";
    case MissionItemKind::kWaypoint:
      return "waypoint";
    case MissionItemKind::kLand:
      return "land";
    case MissionItemKind::kTrajectory:
      return "trajectory";
  }
  return "unknown";
}

}  // namespace swiftlet::ground
