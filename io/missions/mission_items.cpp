#include "swiftlet/io/missions/mission_items.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include <fmt/core.h>

#include "swiftlet/control/planning/checks_in_frame.hpp"
#include "swiftlet/control/planning/waypoint_path.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/math/angles.hpp"

namespace swiftlet::io {
namespace {

using control::MissionItem;
using control::MissionItemKind;
using io::ConfigNode;

constexpr double kLongestHoldS = 3600.0;
constexpr double kLargestRadiusM = 10.0;
constexpr double kLeastCorridorM = 1e-3;  // half width, as in control/planning/waypoint_path.hpp
constexpr double kLargestCorridorM = 10.0;

// A yaw in NED; free: the vehicle keeps its yaw.
struct Yaw {
  bool free = true;
  double rad = 0.0;
};

// The defaults of the last `set` item.
struct Defaults {
  std::optional<double> speed;
  double acceptance_radius_m = 0.0;
  double hold_s = 0.0;
  Yaw yaw;
};

class ItemReader {
 public:
  ItemReader(MissionFrame frame, const Placement& placement, double time_scale, const control::Limits& limits,
             MissionFile& file)
      : frame_(frame), placement_(placement), time_scale_(time_scale), limits_(limits), file_(file) {}

  void read(const ConfigNode& node) {
    node.allow({"kind", "height_m", "position_m", "points", "file", "duration_s", "yaw_rad", "yaw_deg",
                "speed_m_s", "acceptance_radius_m", "hold_s", "straight", "corridor_m", "smoothness"});
    const auto item = node.at("kind").choice<ReadItem>({{"takeoff", &ItemReader::takeoff},
                                                        {"waypoint", &ItemReader::waypoint},
                                                        {"path", &ItemReader::path},
                                                        {"trajectory", &ItemReader::trajectory},
                                                        {"set", nullptr},
                                                        {"wait", &ItemReader::wait},
                                                        {"land", &ItemReader::land}});
    if (item == nullptr) return read_set(node);
    if (!file_.mission.items.empty() && item == &ItemReader::takeoff)
      node.fail("is a takeoff, which must be the first item");
    if (file_.lands()) node.fail("comes after a land, which must be the last item");
    file_.mission.items.push_back((this->*item)(node));
    file_.lines.push_back(node.line());
  }

 private:
  using ReadItem = MissionItem (ItemReader::*)(const ConfigNode&);

  void read_set(const ConfigNode& node) {
    node.allow({"kind", "speed_m_s", "yaw_rad", "yaw_deg", "acceptance_radius_m", "hold_s"});
    const auto speed = node.find("speed_m_s");
    const auto yaw = yaw_in(node);
    const auto radius = node.find("acceptance_radius_m");
    const auto hold = node.find("hold_s");
    if (!speed && !yaw && !radius && !hold)
      node.fail("sets nothing, must give one of speed_m_s, yaw_rad, acceptance_radius_m or hold_s");
    if (speed) defaults_.speed = speed_of(*speed);
    if (yaw) defaults_.yaw = yaw_of(*yaw);
    if (radius) defaults_.acceptance_radius_m = radius->number(io::between(0.0, kLargestRadiusM));
    if (hold) defaults_.hold_s = hold->number(io::between(0.0, kLongestHoldS));
  }

  MissionItem takeoff(const ConfigNode& node) {
    node.allow({"kind", "height_m", "speed_m_s", "hold_s"});
    MissionItem item;
    item.kind = MissionItemKind::kTakeoff;
    const ConfigNode height = node.at("height_m");
    item.position_ned.z() =
        placement_.position(Eigen::Vector3d(0.0, 0.0, -height.number(io::above(0.0)))).z();
    Eigen::Vector3d top_ned =
        0.5 * (limits_.fence_min_ned + limits_.fence_max_ned);  // horizontal position unknown
    top_ned.z() = item.position_ned.z();
    if (!control::check_height("", top_ned.z(), limits_).accepted)
      height.fail(fmt::format("is {:g} m, must be at least the minimum height, {:g} m", -top_ned.z(),
                              limits_.min_height_m));
    require_in_air(height, top_ned);
    item.speed = speed(node);
    item.hold_s = hold(node);
    return item;
  }

  MissionItem waypoint(const ConfigNode& node) {
    node.allow({"kind", "position_m", "yaw_rad", "yaw_deg", "speed_m_s", "acceptance_radius_m", "hold_s"});
    MissionItem item;
    item.kind = MissionItemKind::kWaypoint;
    item.position_ned = position(node.at("position_m"));
    const Yaw yaw = yaw_or_default(node);
    item.yaw_free = yaw.free;
    item.yaw_rad = yaw.rad;
    item.speed = speed(node);
    item.hold_s = hold(node);
    item.acceptance_radius_m = radius(node);
    return item;
  }

  MissionItem wait(const ConfigNode& node) {
    node.allow({"kind", "duration_s"});
    MissionItem item;
    item.kind = MissionItemKind::kWait;
    item.speed = limits_.max_speed;
    item.hold_s = node.at("duration_s").number({0.0, kLongestHoldS, true, false});
    return item;
  }

  MissionItem land(const ConfigNode& node) {
    node.allow({"kind", "speed_m_s"});
    MissionItem item;
    item.kind = MissionItemKind::kLand;
    item.speed = speed(node);
    return item;
  }

  MissionItem path(const ConfigNode& node) {
    node.allow({"kind", "points", "yaw_rad", "yaw_deg", "speed_m_s", "acceptance_radius_m", "hold_s",
                "straight", "corridor_m", "smoothness"});
    const std::vector<ConfigNode> points = node.at("points").items(2, kMaxPoints);
    control::WaypointPath path;
    const bool yaw_free = read_points(points, yaw_or_default(node), path.points);
    read_shape(node, path);
    path.limits = reference_limits(limits_);
    path.limits.speed = speed(node);
    control::PlannedPath planned;
    try {
      planned = control::plan(path);
    } catch (const std::invalid_argument& fault) {
      node.fail(std::string("cannot be planned: ") + fault.what());
    }
    require_flyable(planned, points);
    return add_trajectory(node, std::move(planned.segments), yaw_free, path.limits.speed);
  }

  MissionItem trajectory(const ConfigNode& node) {
    node.allow({"kind", "file", "yaw_rad", "speed_m_s", "acceptance_radius_m", "hold_s"});
    const ConfigNode name = node.at("file");
    const std::filesystem::path path = std::filesystem::path(node.file()).parent_path() / name.text();
    if (!std::filesystem::is_regular_file(path)) {
      name.fail("is " + name.text() + ", must be an existing file: looked for " +
                path.lexically_normal().string());
    }
    const auto yaw = node.find("yaw_rad");
    if (yaw && !yaw_of(*yaw).free) yaw->fail("is a number, must be free; without it the file's yaw is flown");
    TrajectoryFile read = load_trajectory_file(path.string(), name);
    for (const std::string& assumption : read.assumptions)
      file_.assumptions.push_back(name.text() + ": " + assumption);
    return add_trajectory(node, std::move(read.segments), yaw.has_value(), speed(node));
  }

  TrajectoryFile load_trajectory_file(const std::string& path, const ConfigNode& name) const {
    FileOptions options;
    options.placement = placement_;
    options.time_scale = time_scale_;
    const Source source = read_source(path, options);
    if (source.format != MissionFormat::kPolynomialCsv && source.format != MissionFormat::kSampledCsv)
      name.fail("is " + name.text() + ", must be a trajectory: polynomials or samples as CSV");
    TrajectoryFile file = *path_of(source, limits_, options);
    for (control::PolynomialSegment& segment : file.segments)
      segment = control::stretched(segment, 1.0 / time_scale_);
    return file;
  }

  // Adds the segments to those of the mission.
  MissionItem add_trajectory(const ConfigNode& node, std::vector<control::PolynomialSegment> segments,
                             bool yaw_free, double speed) {
    std::vector<control::PolynomialSegment>& all = file_.mission.segments;
    MissionItem item;
    item.kind = MissionItemKind::kTrajectory;
    item.yaw_free = yaw_free;
    item.speed = speed;
    item.hold_s = hold(node);
    item.acceptance_radius_m = radius(node);
    item.first_segment = static_cast<std::uint32_t>(all.size());
    item.segment_count = static_cast<std::uint32_t>(segments.size());
    all.insert(all.end(), segments.begin(), segments.end());
    if (all.size() > control::kMaxTrajectorySegments) {
      node.fail(fmt::format("needs {} segments, {} with the items before it, a mission has at most {}",
                            segments.size(), all.size(), control::kMaxTrajectorySegments));
    }
    return item;
  }

  // A point without a yaw takes that of the previous point; points before the first yaw take the first one.
  // Returns true if no point has a yaw: the yaw is then free.
  bool read_points(const std::vector<ConfigNode>& nodes, const Yaw& fallback,
                   std::vector<control::PathPoint>& points) const {
    Yaw last = fallback;
    std::size_t without = 0;  // points before the first yaw
    for (const ConfigNode& node : nodes) {
      control::PathPoint& point = points.emplace_back();
      if (node.is_list()) {
        point.position_ned = position(node);
      } else {
        node.allow({"position_m", "yaw_rad", "yaw_deg", "stop"});
        point.position_ned = position(node.at("position_m"));
        if (const auto stop = node.find("stop")) point.stop = stop->boolean();
        if (const auto yaw = yaw_in(node)) {
          const double to = wrapped_yaw_ned(*yaw);
          last = {false, last.free ? to : last.rad + std::remainder(to - last.rad, 2.0 * M_PI)};
        }
      }
      point.yaw_rad = last.rad;
      if (last.free) without = points.size();
    }
    for (std::size_t i = 0; i < without && !last.free; ++i) points[i].yaw_rad = points[without].yaw_rad;
    return last.free;
  }

  void read_shape(const ConfigNode& node, control::WaypointPath& path) const {
    if (const auto smoothness = node.find("smoothness")) {
      path.smoothness = smoothness->choice<control::Smoothness>(
          {{"snap", control::Smoothness::kMinimumSnap}, {"jerk", control::Smoothness::kMinimumJerk}});
    }
    const auto straight = node.find("straight");
    const auto corridor = node.find("corridor_m");
    control::Leg leg;
    if (straight && straight->boolean()) {
      if (corridor) corridor->fail("is given for a path of straight legs, must be left out");
      leg.shape = control::LegShape::kStraight;
    } else if (corridor) {
      leg.shape = control::LegShape::kCorridor;
      leg.corridor_m = placement_.scale * corridor->number(io::between(kLeastCorridorM, kLargestCorridorM));
    }
    path.legs.assign(path.points.size() - 1, leg);
  }

  // Checks the whole path, also between its points.
  void require_flyable(const control::PlannedPath& planned, const std::vector<ConfigNode>& points) const {
    const std::string what = in_frame(frame_);
    std::size_t leg = 0;
    for (std::size_t i = 0; i < planned.segments.size(); ++i) {
      while (leg + 1 < planned.leg_begins.size() && planned.leg_begins[leg + 1] <= i) ++leg;
      const control::Outcome outcome =
          control::check_segment({what.c_str(), frame_}, planned.segments[i], limits_);
      if (!outcome.accepted) points[leg].fail(std::string("the path from here, ") + outcome.reason);
    }
  }

  void require_in_air(const ConfigNode& node, const Eigen::Vector3d& position_ned) const {
    const std::string fault = position_fault(position_ned, frame_, limits_);
    if (!fault.empty()) node.fail(fault);
  }

  Eigen::Vector3d position(const ConfigNode& node) const {
    const Eigen::Vector3d position_ned = placement_.position(ned_from(frame_, node.vector3()));
    require_in_air(node, position_ned);
    return position_ned;
  }

  double speed_of(const ConfigNode& node) const { return node.number({0.0, limits_.max_speed, true, false}); }
  double speed(const ConfigNode& node) const {
    const auto given = node.find("speed_m_s");
    if (given || !defaults_.speed) return speed_of(node.at("speed_m_s"));
    return *defaults_.speed;
  }
  double hold(const ConfigNode& node) const {
    const auto given = node.find("hold_s");
    return given ? given->number(io::between(0.0, kLongestHoldS)) : defaults_.hold_s;
  }
  double radius(const ConfigNode& node) const {
    const auto given = node.find("acceptance_radius_m");
    return given ? given->number(io::between(0.0, kLargestRadiusM)) : defaults_.acceptance_radius_m;
  }

  static std::optional<ConfigNode> yaw_in(const ConfigNode& node) {
    const auto rad = node.find("yaw_rad");
    const auto deg = node.find("yaw_deg");
    if (rad && deg) deg->fail("is given beside yaw_rad, must be one of both");
    return rad ? rad : deg;
  }

  static double radians(const ConfigNode& node) {
    if (node.key().substr(node.key().size() - 3) == "deg")
      return math::kRadPerDeg * node.number(io::between(-180.0, 180.0));
    const io::Bounds half_turns = io::between(-M_PI, M_PI);
    const double yaw = node.number();
    if (!half_turns.contains(yaw))
      node.fail(fmt::format("is {:g}, must be {}: {:g} degrees are {:.4f} rad, yaw_deg takes degrees", yaw,
                            half_turns.to_string(), yaw, math::kRadPerDeg * yaw));
    return yaw;
  }

  double wrapped_yaw_ned(const ConfigNode& node) const {
    return std::remainder(placement_.yaw(ned_yaw_from(frame_, radians(node))), 2 * M_PI);
  }

  // Reads a number in rad or degrees, or the word free.
  Yaw yaw_of(const ConfigNode& node) const {
    if (node.is_scalar() && node.text() == "free") return {};
    return {false, wrapped_yaw_ned(node)};
  }
  Yaw yaw_or_default(const ConfigNode& node) const {
    const auto given = yaw_in(node);
    return given ? yaw_of(*given) : defaults_.yaw;
  }

  const MissionFrame frame_;
  const Placement& placement_;
  const double time_scale_;
  const control::Limits& limits_;
  MissionFile& file_;
  Defaults defaults_;
};

}  // namespace

void read_mission_items(const ConfigNode& list, MissionFrame frame, const Placement& placement,
                        double time_scale, const control::Limits& limits, MissionFile& file) {
  ItemReader reader(frame, placement, time_scale, limits, file);
  for (const ConfigNode& node : list.items(1, control::kMaxMissionItems)) reader.read(node);
  if (file.mission.items.empty()) list.fail("has no item to fly, must have at least one besides set");
}

}  // namespace swiftlet::io
