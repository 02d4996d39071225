#include "swiftlet/io/missions/mission_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/core.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/io/config.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "swiftlet/io/missions/mission_items.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {
namespace {

using control::MissionItem;
using control::MissionItemKind;
using io::ConfigNode;

constexpr double kLargestToleranceM = 10.0;
constexpr int kMaxName = 64;

std::string name_of(const ConfigNode& root) {
  const auto node = root.find("name");
  if (!node) return std::filesystem::path(root.file()).stem().string();
  std::string name = node->text();
  if (name.size() > kMaxName || name.find('/') != std::string::npos)
    node->fail("must be at most " + std::to_string(kMaxName) + " characters and hold no /");
  return name;
}

void read_limits(const ConfigNode& node, const control::Limits& settings, control::MissionBounds& bounds) {
  node.allow({"speed_m_s", "acceleration_m_s2", "jerk_m_s3", "yaw_rate_rad_s"});
  const auto read = [&](const char* key, double most, double& bound) {
    if (const auto limit = node.find(key)) bound = limit->number({0.0, most, true, false});
  };
  read("speed_m_s", settings.max_speed, bounds.max_speed);
  read("acceleration_m_s2", settings.max_acceleration, bounds.max_acceleration);
  read("jerk_m_s3", settings.max_reference_jerk, bounds.max_jerk);
  read("yaw_rate_rad_s", settings.max_yaw_rate, bounds.max_yaw_rate);
}

// The bounds with this fence.
control::MissionBounds fenced(control::MissionBounds bounds, const Eigen::Vector3d& corner_ned,
                              const Eigen::Vector3d& other_ned) {
  bounds.fenced = true;
  bounds.fence_min_ned = corner_ned.cwiseMin(other_ned);
  bounds.fence_max_ned = corner_ned.cwiseMax(other_ned);
  return bounds;
}

// The bounds of --fence, if it is given.
control::MissionBounds fence_of(const FileOptions& options, const control::Limits& settings) {
  if (!options.fence) return {};
  control::MissionBounds bounds = fenced({}, options.fence->min_ned, options.fence->max_ned);
  const control::Outcome outcome = control::check(bounds, settings);
  if (!outcome.accepted) throw io::ConfigError("--fence", 0, "", outcome.reason);
  return bounds;
}

void read_fence(const ConfigNode& node, MissionFrame frame, const Placement& placement,
                const control::Limits& settings, control::MissionBounds& bounds) {
  node.allow({"min_m", "max_m"});
  const Eigen::Vector3d least = node.at("min_m").vector3();
  const Eigen::Vector3d greatest = node.at("max_m").vector3();
  for (int i = 0; i < 3; ++i) {
    if (greatest[i] > least[i]) continue;
    node.at("max_m").fail(
        fmt::format("number {} is {:g}, must be above that of min_m, {:g}", i + 1, greatest[i], least[i]));
  }
  if (!placement.keeps_axes())
    node.fail(fmt::format(
        "has sides along the axes: --rotate must be a multiple of 90 deg, is {:g}, unless --fence is "
        "given in its place",
        placement.rotate_deg));
  bounds = fenced(bounds, placement.position(ned_from(frame, least)),
                  placement.position(ned_from(frame, greatest)));
  const control::Outcome outcome = control::check(bounds, settings);
  if (!outcome.accepted)
    node.fail((frame == MissionFrame::kNed ? "" : "in NED: ") + std::string(outcome.reason));
}

// Requires all other keys before the items: otherwise a truncated file would lose them without an error.
void require_items_last(const ConfigNode& root, const ConfigNode& items) {
  for (const char* key : {"name", "description", "frame", "tolerance_m", "limits", "geofence", "ends"}) {
    const auto node = root.find(key);
    if (node && node->line() > items.line())
      node->fail("stands after items, must stand before them: a truncated file would lose it silently");
  }
}

// The frame of the file, or that of --frame if it names none.
MissionFrame frame_of(const ConfigNode& root, const FileOptions& options) {
  const auto node = root.find("frame");
  if (!node && options.frame) return *options.frame;
  const MissionFrame frame = root.at("frame").choice<MissionFrame>(
      {{"ned", MissionFrame::kNed}, {"enu", MissionFrame::kEnu}, {"nwu", MissionFrame::kNwu}});
  if (options.frame && *options.frame != frame)
    node->fail(std::string("is ") + frame_name(frame) + ", but --frame names " + frame_name(*options.frame));
  return frame;
}

MissionFile read_mission(const ConfigNode& root, const control::Limits& settings,
                         const FileOptions& options) {
  root.allow({"name", "description", "frame", "tolerance_m", "limits", "geofence", "ends", "items"});
  MissionFile file;
  file.name = name_of(root);
  if (const auto description = root.find("description")) file.description = description->text();
  const MissionFrame frame = frame_of(root, options);
  file.tolerance_m = root.at("tolerance_m").number({0.0, kLargestToleranceM, true, false});
  control::MissionBounds& bounds = file.mission.bounds;
  bounds = fence_of(options, settings);
  if (const auto limits = root.find("limits")) read_limits(*limits, settings, bounds);
  const auto fence = root.find("geofence");
  if (fence && !options.fence) read_fence(*fence, frame, options.placement, settings, bounds);
  const auto ends = root.find("ends");
  const bool hovers = ends && ends->choice<bool>({{"landed", false}, {"hovering", true}});

  const ConfigNode items = root.at("items");
  require_items_last(root, items);
  const control::Limits limits = control::tightened(settings, bounds);
  read_mission_items(items, frame, options.placement, options.time_scale, limits, file);
  if (hovers && file.lands()) ends->fail("is hovering, must be landed: the last item is a land");
  if (!hovers && !file.lands()) {
    const ConfigNode last = items.items().back();
    last.fail("is the last item, which must be a land unless the mission has `ends: hovering`");
  }
  return file;
}

// The time scale may be below 1, so that limits are exceeded.
MissionFile time_scaled(MissionFile file, const control::Limits& limits, const FileOptions& options,
                        const std::string& path) {
  if (options.time_scale == 1.0) return file;
  file = stretched(std::move(file), options.time_scale);
  const control::Outcome outcome = control::check(file.mission, limits);
  if (!outcome.accepted)
    throw io::ConfigError(path, 0, "",
                          fmt::format("with --time-scale {:g}: {}", options.time_scale, outcome.reason));
  return file;
}

void say_placement(const FileOptions& options, std::vector<std::string>& assumptions) {
  if (!options.placement.is_identity()) assumptions.push_back(options.placement.sentence());
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

MissionFile parse_any_mission_file(const std::string& text, const std::string& file_name,
                                   const control::Limits& settings, const FileOptions& options) {
  const Source source = parse_source(text, file_name, options);
  const control::MissionBounds bounds = fence_of(options, settings);
  const control::Limits limits = control::tightened(settings, bounds);
  MissionFile file;
  if (auto path = path_of(source, limits, options)) {
    file = whole_flight(file_name, std::move(*path), limits);
  } else if (source.plan) {
    file = time_scaled(mission_of(*source.plan, limits, options.placement), limits, options, file_name);
    file.assumptions.insert(file.assumptions.begin(), source.assumptions.begin(), source.assumptions.end());
  } else {
    file = time_scaled(parse_mission_file(text, file_name, settings, options), settings, options, file_name);
  }
  if (source.format != MissionFormat::kYaml) file.mission.bounds = bounds;
  say_placement(options, file.assumptions);
  return file;
}

MissionFile load_mission_file(const std::string& path, const control::Limits& settings,
                              const FileOptions& options) {
  return parse_any_mission_file(read_text_file(path), path, settings, options);
}

TrajectoryFile load_trajectory_file(const std::string& path, const control::Limits& settings,
                                    const FileOptions& options) {
  const control::Limits limits = control::tightened(settings, fence_of(options, settings));
  if (auto file = path_of(read_source(path, options), limits, options)) {
    say_placement(options, file->assumptions);
    return std::move(*file);
  }
  MissionFile file = load_mission_file(path, settings, options);
  const auto is_trajectory = [](const control::MissionItem& item) {
    return item.kind == control::MissionItemKind::kTrajectory;
  };
  const auto& items = file.mission.items;
  if (std::count_if(items.begin(), items.end(), is_trajectory) != 1) {
    throw io::ConfigError(path, 0, "", "must hold exactly one trajectory; `swiftlet fly` flies missions");
  }
  return {std::move(file.mission.segments), std::move(file.assumptions)};
}

MissionFile parse_mission_file(const std::string& text, const std::string& file_name,
                               const control::Limits& limits, const FileOptions& options) {
  return read_mission(io::parse_config(text, file_name), limits, options);
}

MissionFile stretched(MissionFile file, double factor) {
  if (!file.is_path) {
    file.mission = control::stretched(std::move(file.mission), factor);
    return file;
  }
  for (control::PolynomialSegment& segment : file.mission.segments)
    segment = control::stretched(segment, factor);
  return file;
}

double planned_duration_s(const control::Mission& mission, const control::Limits& settings) {
  const control::Limits limits = control::tightened(settings, mission.bounds);
  double duration_s = 0.0;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  double yaw = 0.0;
  for (const MissionItem& item : mission.items) {
    Eigen::Vector3d to = at;
    if (item.kind == MissionItemKind::kWaypoint) to = item.position_ned;
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
      turn_s = 15.0 / 8.0 * std::abs(std::remainder(item.yaw_rad - yaw, 2 * M_PI)) / limits.max_yaw_rate;
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

}  // namespace swiftlet::io
