#include "swiftlet/io/missions/whole_flight.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include <fmt/core.h>

#include "swiftlet/control/planning/bernstein.hpp"
#include "swiftlet/control/planning/checks_in_frame.hpp"
#include "swiftlet/io/config_error.hpp"

namespace swiftlet::io {
namespace {

constexpr double kTrackingTolerance_m = 0.1;  // of the tracking error, as in config/missions
constexpr double kGround_m = 0.1;             // an estimate on the ground may be as far below it

control::Polynomial negative(control::Polynomial polynomial) {
  for (double& c : polynomial) c = -c;
  return polynomial;
}

}  // namespace

control::PolynomialSegment ned_segment(MissionFrame frame, const control::PolynomialSegment& segment) {
  if (frame == MissionFrame::kNed) return segment;
  const bool enu = frame == MissionFrame::kEnu;
  control::PolynomialSegment ned{segment.duration_s, enu ? segment.y : segment.x,
                                 enu ? segment.x : negative(segment.y), negative(segment.z),
                                 negative(segment.yaw)};
  ned.yaw[0] = ned_yaw_from(frame, segment.yaw[0]);
  return ned;
}

void Heights::add(double z_ned) {
  least_m = std::min(least_m, -z_ned);
  greatest_m = std::max(greatest_m, -z_ned);
}

double raise_by(const Heights& heights, ReadFrame read, const std::string& file_name,
                std::vector<std::string>& assumptions) {
  const MissionFrame frame = read.frame;
  if (heights.greatest_m < 0.0) {
    const MissionFrame other = frame == MissionFrame::kNed ? MissionFrame::kEnu : MissionFrame::kNed;
    const auto axis = [](MissionFrame of) { return of == MissionFrame::kNed ? "down" : "up"; };
    throw io::ConfigError(
        file_name, 0, "",
        fmt::format(
            "the whole path is below the ground, at heights of {:.2f} to {:.2f} m: z is read as {} ({}); "
            "if it points {} in this file, the frame is {}: --frame {}",
            heights.least_m, heights.greatest_m, axis(frame), frame_title(frame), axis(other),
            frame_title(other), frame_name(other)));
  }
  const auto rounded = [](double height_m) {
    return std::round(height_m * 100.0) / 100.0 + 0.0;
  };  // no -0.00
  const double rounded_m = rounded(heights.least_m);
  if (heights.least_m >= kLeastHeight_m) {
    assumptions.push_back(
        fmt::format("heights are above the ground: the lowest point is {:.2f} m", rounded_m));
    return 0.0;
  }
  const double raise_m = kHoverHeight_m - heights.least_m;
  if (read.is_assumed && heights.least_m < -kGround_m) {
    throw io::ConfigError(
        file_name, 0, "",
        fmt::format(
            "z goes from {:.2f} to {:.2f} m, and the file names no frame. If z points up, the path is "
            "about a hover and is raised by {:.2f} m: --frame enu or nwu. If z points down, its heights "
            "are {:.2f} to {:.2f} m: --frame ned. A header such as z_enu [m] says it too",
            rounded_m, rounded(heights.greatest_m), raise_m, rounded(-heights.greatest_m), -rounded_m));
  }
  assumptions.push_back(
      fmt::format("the lowest point is {:.2f} m, so heights are relative to a hover: raised by {:.2f} m",
                  rounded_m, raise_m));
  return raise_m;
}

Heights heights_of(const std::vector<control::PolynomialSegment>& segments) {
  constexpr double kTolerance = 1e-6;  // m
  Heights heights;
  for (const control::PolynomialSegment& segment : segments) {
    heights.add(control::maximum(control::bernstein(segment.z, segment.duration_s), kTolerance).value);
    heights.add(
        -control::maximum(control::bernstein(negative(segment.z), segment.duration_s), kTolerance).value);
  }
  return heights;
}

control::MotionLimits reference_limits(const control::Limits& limits) {
  return {limits.max_speed, limits.max_reference_acceleration, limits.max_reference_jerk,
          limits.max_yaw_rate};
}

std::optional<double> slower_within(const std::vector<control::PolynomialSegment>& segments,
                                    const control::Limits& limits) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const control::MotionLimits motion = {limits.max_speed, limits.max_acceleration, kNone, kNone};
  double factor = 1.0;
  for (const control::PolynomialSegment& segment : segments)
    factor = std::max(factor, control::limit_use(segment, motion).stretch());
  factor = std::ceil(factor * 100.0) / 100.0;
  if (factor > kLargestTimeScale) return std::nullopt;
  for (const control::PolynomialSegment& segment : segments) {
    if (!control::check_segment("", control::stretched(segment, factor), limits).accepted)
      return std::nullopt;
  }
  return factor;
}

std::string advice_of(double slower, const FileOptions& options) {
  return fmt::format("slower by {:.3g}: --time-scale {:.4g}", slower,
                     std::ceil(slower * options.time_scale * 100.0 - 1e-6) / 100.0);
}

std::string position_fault(const Eigen::Vector3d& position_ned, MissionFrame frame,
                           const control::Limits& limits) {
  const std::string what = in_frame(frame);
  const control::Outcome height = control::check_height({what.c_str(), frame}, position_ned.z(), limits);
  if (!height.accepted) return height.reason;
  const bool down = frame == MissionFrame::kNed;
  const char* const directions[] = {"north", "east", down ? "down" : "up"};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = limits.fence_min_ned[axis];
    const double high = limits.fence_max_ned[axis];
    if (position_ned[axis] >= low && position_ned[axis] <= high) continue;
    const double sign = axis == 2 && !down ? -1.0 : 1.0;
    const double nearest_mm = std::round(1e3 * position_ned[axis]);
    return fmt::format("{} is {:.10g} m, must be inside the fence, {:g} to {:g} m", directions[axis],
                       1e-3 * sign * nearest_mm, std::min(sign * low, sign * high) + 0.0,
                       std::max(sign * low, sign * high) + 0.0);
  }
  return "";
}

TrajectoryFile checked(TrajectoryFile path, MissionFrame frame, const control::Limits& limits,
                       const FileOptions& options, const std::function<void(const PathFault&)>& refuse) {
  const std::vector<control::PolynomialSegment>& segments = path.segments;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::string what = fmt::format("segment {} in {}", i + 1, frame_title(frame));
    control::Outcome outcome = i == 0 ? control::check_start(what.c_str(), segments[i])
                                      : control::check_joint(what.c_str(), segments[i - 1], segments[i]);
    if (!outcome.accepted) refuse({i, outcome.reason, ""});
    outcome = control::check_segment({what.c_str(), frame}, segments[i], limits);
    if (outcome.accepted) continue;
    const std::optional<double> slower = slower_within(segments, limits);
    refuse({i, outcome.reason, slower && *slower > 1.0 ? advice_of(*slower, options) : ""});
  }
  const std::string last = fmt::format("segment {} in {}", segments.size(), frame_title(frame));
  const control::Outcome outcome = control::check_end(last.c_str(), segments.back());
  if (!outcome.accepted) refuse({segments.size() - 1, outcome.reason, ""});
  return path;
}

MissionFile whole_flight(const std::string& file_name, TrajectoryFile path, const control::Limits& limits) {
  using control::MissionItemKind;
  std::vector<control::PolynomialSegment>& segments = path.segments;
  double duration_s = 0.0;
  for (const control::PolynomialSegment& segment : segments) duration_s += segment.duration_s;
  const double speed = std::min(kApproachSpeed, limits.max_speed);
  MissionFile file;
  file.name = std::filesystem::path(file_name).stem().string();
  file.tolerance_m = kTrackingTolerance_m;
  file.mission.items = {{MissionItemKind::kTakeoff, {0.0, 0.0, segments.front().z[0]}, 0.0, true, speed, 0.5},
                        {MissionItemKind::kTrajectory, Eigen::Vector3d::Zero(), 0.0, false, speed, 0.5, 0,
                         static_cast<std::uint32_t>(segments.size())},
                        {MissionItemKind::kLand, Eigen::Vector3d::Zero(), 0.0, true, speed, 0.0}};
  path.assumptions.push_back(
      fmt::format("take-off to {:.2f} m and a landing are added; the path takes {:.1f} s in {} segments",
                  -segments.front().z[0], duration_s, segments.size()));
  file.mission.segments = std::move(segments);
  file.assumptions = std::move(path.assumptions);
  file.is_path = true;
  return file;
}

}  // namespace swiftlet::io
