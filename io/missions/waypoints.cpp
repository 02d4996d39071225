#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include "swiftlet/control/planning/checks_in_frame.hpp"
#include "swiftlet/control/planning/waypoint_path.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "swiftlet/io/missions/motion_columns.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"

namespace swiftlet::io {
namespace {

control::WaypointPath read(const Table& table, const MotionColumns& columns) {
  control::WaypointPath path;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (row == kMaxPoints)
      table.fail(row, "x,y,z", fmt::format("is waypoint {}, at most {} fit", row + 1, kMaxPoints));
    const std::vector<double> numbers = table.row(row);
    control::PathPoint& point = path.points.emplace_back();
    point.position_ned = columns.ned(numbers, Motion::kX);
    if (!columns.has(Motion::kYaw)) continue;
    const std::string what = fmt::format("waypoint {}", row + 1);
    const control::Outcome yaw = control::check_yaw(what.c_str(), columns.value(numbers, Motion::kYaw));
    if (!yaw.accepted) table.fail(row, "yaw", yaw.reason);
    point.yaw_rad = columns.yaw_ned(numbers);
    if (row == 0) continue;
    const double before = path.points[row - 1].yaw_rad;  // unwrapped
    point.yaw_rad = before + std::remainder(point.yaw_rad - before, 2.0 * M_PI);
  }
  return path;
}

// Returns the row of the last waypoint at or before the start of a segment.
std::size_t row_of(const control::PlannedPath& planned, std::size_t segment) {
  std::size_t row = 0;
  while (row + 1 < planned.leg_begins.size() && planned.leg_begins[row + 1] <= segment) ++row;
  return row;
}

}  // namespace

TrajectoryFile read_waypoints(const Table& table, const control::Limits& limits, const FileOptions& options) {
  const MotionColumns columns(table.columns(), table.file(), options.frame);
  require_columns(columns, table.file(), "a list of waypoints", {Motion::kX, Motion::kY, Motion::kZ},
                  {{Motion::kYaw}});
  table.require_rows(2);
  control::WaypointPath path = read(table, columns);
  path.limits = reference_limits(limits);

  std::vector<std::string> assumptions;
  if (const auto assumption = columns.assumption("waypoints")) assumptions.push_back(*assumption);
  if (!columns.has(Motion::kYaw)) assumptions.emplace_back("the file has no yaw: the vehicle faces north");
  const std::string what = in_frame(columns.frame());
  Heights heights;
  for (const control::PathPoint& point : path.points) heights.add(point.position_ned.z());
  const double raise_m =
      raise_by(heights, {columns.frame(), columns.frame_is_assumed()}, table.file(), assumptions);
  for (std::size_t row = 0; row < path.points.size(); ++row) {
    Eigen::Vector3d& position_ned = path.points[row].position_ned;
    position_ned.z() -= raise_m;
    position_ned = options.placement.position(position_ned);
    path.points[row].yaw_rad = options.placement.yaw(path.points[row].yaw_rad);
    const control::Outcome inside =
        control::check_position({what.c_str(), columns.frame()}, position_ned, limits);
    if (!inside.accepted) table.fail(row, "x,y,z", inside.reason);
  }
  assumptions.push_back(fmt::format(
      "flown without stopping on a path of minimum snap, at up to {:g} m/s, {:g} m/s^2 and {:g} m/s^3",
      path.limits.speed, path.limits.acceleration, path.limits.jerk));
  control::PlannedPath planned;
  try {
    planned = control::plan(path);
  } catch (const std::invalid_argument& fault) {
    throw io::ConfigError(table.file(), 0, "", fault.what());
  }
  for (control::PolynomialSegment& segment : planned.segments)
    segment = control::stretched(segment, options.time_scale);
  return checked({std::move(planned.segments), std::move(assumptions)}, columns.frame(), limits, options,
                 [&](const PathFault& fault) {
                   table.fail(row_of(planned, fault.segment), "", "the path from here: " + fault.sentence());
                 });
}

}  // namespace swiftlet::io
