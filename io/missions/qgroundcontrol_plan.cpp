// File format: https://docs.qgroundcontrol.com/master/en/qgc-dev-guide/file_formats/plan.html. Commands and
// frames: https://mavlink.io/en/messages/common.html.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/io/config.hpp"
#include "swiftlet/io/missions/mission_format.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"
#include "swiftlet/math/geodesy.hpp"

namespace swiftlet::io {
namespace {

using control::MissionItem;
using control::MissionItemKind;
using io::ConfigNode;

constexpr double kHomeTolerance_m = 0.1;
constexpr double kLongestHold_s = 3600.0;
constexpr double kSamePlace_m = 0.01;
constexpr double kTakeoffPlace_m = 1.0;  // largest distance of the take-off item from home
constexpr double kHighest_m = 1e5;
constexpr double kDefaultSpeed = 0.5;  // m/s

// The supported values of MAV_CMD and MAV_FRAME.
constexpr int kWaypoint = 16;
constexpr int kLoiterTime = 19;
constexpr int kReturnToLaunch = 20;
constexpr int kLand = 21;
constexpr int kTakeoff = 22;
constexpr int kChangeSpeed = 178;
constexpr const char* kCommands =
    "16 (waypoint), 19 (loiter for a time), 20 (return to launch), 21 (land), 22 (take-off) or 178 (change "
    "speed)";
constexpr int kGlobal = 0;
constexpr int kLocalNed = 1;
constexpr int kGlobalRelative = 3;
constexpr int kLocalEnu = 4;

struct Home {
  math::GeographicPosition position;
  double altitude_m = 0.0;
};

// JSON is valid YAML in flow style, and the YAML reader reports lines. nlohmann::json only checks that it is
// JSON.
ConfigNode read_json(std::string text, const std::string& file_name) {
  try {
    [[maybe_unused]] const auto valid = nlohmann::json::parse(text);
  } catch (const nlohmann::json::out_of_range&) {  // such as 1e309; no position given
    throw io::ConfigError(file_name, 0, "", "holds a number beyond 1.8e308, must hold smaller ones");
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t at = std::min(error.byte, text.size());
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(at);
    const auto line = 1 + std::count(text.begin(), end, '\n');
    const std::size_t line_begin = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    const std::size_t column = line_begin == std::string::npos ? at : at - line_begin - 1;
    throw io::ConfigError(file_name, static_cast<int>(line),
                          "column " + std::to_string(std::max<std::size_t>(column, 1)),
                          text.empty() ? "the file is empty, must be a JSON document" : "is invalid JSON");
  }
  std::replace(text.begin(), text.end(), '\t', ' ');  // tabs separate values in JSON but not in YAML
  if (text.back() != '\n') text += '\n';
  return io::parse_config(text, file_name);
}

// JSON's null.
bool is_null(const ConfigNode& node) { return !node.is_map() && !node.is_list() && !node.is_scalar(); }

class PlanReader {
 public:
  PlanReader(const ConfigNode& root, const control::Limits& limits, const Placement& placement)
      : root_(root), limits_(limits), placement_(placement) {}

  MissionFile read(const std::string& file_name) {
    if (const ConfigNode type = root_.at("fileType"); type.text() != "Plan")
      type.fail("is " + type.text() + ", must be Plan");
    const ConfigNode mission = root_.at("mission");
    if (const auto home = mission.find("plannedHomePosition")) read_home(*home);
    read_speed(mission);
    for (const ConfigNode& item : mission.at("items").items(1, control::kMaxMissionItems)) read_item(item);
    complete();
    MissionFile file;
    file.name = std::filesystem::path(file_name).stem().string();
    file.tolerance_m = kHomeTolerance_m;
    file.mission.items = std::move(items_);
    file.assumptions = assumptions();
    return file;
  }

 private:
  void read_home(const ConfigNode& node) {
    const std::vector<ConfigNode> values = node.items(3, 3);
    home_ = Home{{values[0].number(io::between(-90.0, 90.0)), values[1].number(io::between(-180.0, 180.0))},
                 values[2].number(io::between(-kHighest_m, kHighest_m))};
  }

  void read_speed(const ConfigNode& mission) {
    const auto node = mission.find("hoverSpeed");
    const double wanted = node && !is_null(*node) ? node->number(io::above(0.0)) : kDefaultSpeed;
    set_speed(wanted);
  }
  void set_speed(double wanted) {
    speed_ = std::min(wanted, limits_.max_speed);
    if (speed_ < wanted) fastest_wanted_ = std::max(fastest_wanted_, wanted);
  }

  void read_item(const ConfigNode& item) {
    const ConfigNode type = item.at("type");
    if (type.text() != "SimpleItem")
      type.fail("is " + type.text() + ", must be SimpleItem: draw the pattern as waypoints");
    const ConfigNode command = item.at("command");
    const std::vector<ConfigNode> params = item.at("params").items(7, 7);
    if (landed_) item.fail("follows a landing, which must be the last item");
    switch (command.integer(0, 65535)) {
      case kTakeoff:
        return add_takeoff(item, params);
      case kWaypoint:
      case kLoiterTime:
        return add_waypoint(item, params);
      case kLand:
        return add_landing(item, params);
      case kReturnToLaunch:
        need_height(item);
        return land_at(item, {0.0, 0.0});
      case kChangeSpeed:
        return set_speed(params[1].number(io::above(0.0)));
      default:
        command.fail("is " + std::to_string(command.integer()) + ", must be " + kCommands);
    }
  }

  void add_takeoff(const ConfigNode& item, const std::vector<ConfigNode>& params) {
    if (!items_.empty()) item.fail("is a take-off, which must be the first item");
    const Eigen::Vector3d place = position(item, params, true);
    const double aside_m = place.head<2>().norm();
    if (aside_m > kTakeoffPlace_m) {
      item.fail(
          fmt::format("takes off {:.1f} m from home, must be at most {:.0f} m: the vehicle stands at home",
                      aside_m, kTakeoffPlace_m));
    }
    require_inside(item, {0.0, 0.0, place.z()});
    takeoff_aside_m_ = aside_m;
    add({MissionItemKind::kTakeoff, {0.0, 0.0, place.z()}, 0.0, true, speed_, 0.0});
  }

  void add_waypoint(const ConfigNode& item, const std::vector<ConfigNode>& params) {
    MissionItem waypoint;
    waypoint.kind = MissionItemKind::kWaypoint;
    waypoint.position_ned = position(item, params, false);
    require_inside(item, waypoint.position_ned);
    waypoint.speed = speed_;
    if (!is_null(params[0])) waypoint.hold_s = params[0].number(io::between(0.0, kLongestHold_s));
    if (!is_null(params[3])) {
      waypoint.yaw_free = false;
      waypoint.yaw_rad =
          std::remainder(params[3].number(io::between(-360.0, 360.0)) * M_PI / 180.0, 2.0 * M_PI);
    }
    need_takeoff(waypoint.position_ned.z());
    add(waypoint);
  }

  void add_landing(const ConfigNode& item, const std::vector<ConfigNode>& params) {
    need_height(item);
    const bool somewhere = !is_null(params[4]) && !is_null(params[5]);
    land_at(item, somewhere ? Eigen::Vector2d(position(item, params, true).head<2>()) : at_.head<2>());
  }

  // Flies to a place at the present height, then lands straight down.
  void land_at(const ConfigNode& item, const Eigen::Vector2d& place) {
    const Eigen::Vector3d above(place.x(), place.y(), at_.z());
    require_inside(item, above);
    if ((above - at_).norm() > kSamePlace_m) add({MissionItemKind::kWaypoint, above, 0.0, true, speed_, 0.0});
    add({MissionItemKind::kLand, Eigen::Vector3d::Zero(), 0.0, true, speed_, 0.0});
    landed_ = true;
  }

  void need_height(const ConfigNode& item) const {
    if (items_.empty()) item.fail("is the first item, must follow a take-off or a waypoint");
  }
  void need_takeoff(double z_ned) {
    if (!items_.empty()) return;
    add({MissionItemKind::kTakeoff, {0.0, 0.0, z_ned}, 0.0, true, speed_, 0.0});
    takeoff_added_ = true;
  }
  void complete() {
    if (items_.empty())
      root_.at("mission").at("items").fail("has no item to fly, must have a take-off or a waypoint");
    if (landed_) return;
    add({MissionItemKind::kLand, Eigen::Vector3d::Zero(), 0.0, true, speed_, 0.0});
    landing_added_ = true;
  }

  void add(const MissionItem& item) {
    if (items_.size() == control::kMaxMissionItems)
      root_.at("mission").at("items").fail(
          fmt::format("has more than {} items with those added", control::kMaxMissionItems));
    MissionItem placed = item;
    placed.position_ned = placement_.position(item.position_ned);
    if (!item.yaw_free) placed.yaw_rad = std::remainder(placement_.yaw(item.yaw_rad), 2.0 * M_PI);
    items_.push_back(placed);
    if (item.kind != MissionItemKind::kLand) at_ = item.position_ned;
  }

  // Returns the position in the plan: in NED from home, m. Take-offs and landings may omit the horizontal position.
  Eigen::Vector3d position(const ConfigNode& item, const std::vector<ConfigNode>& params,
                           bool place_optional) {
    const ConfigNode frame = item.at("frame");
    const std::int64_t kind = frame.integer(0, 255);
    const bool placed = !place_optional || (!is_null(params[4]) && !is_null(params[5]));
    switch (kind) {
      case kGlobal:
      case kGlobalRelative: {
        if (!home_)
          root_.at("mission").fail("has items with geographic coordinates, must have a plannedHomePosition");
        global_ = true;
        Eigen::Vector2d north_east = at_.head<2>();
        if (placed) {
          north_east = math::north_east_of(home_->position, {params[4].number(io::between(-90.0, 90.0)),
                                                             params[5].number(io::between(-180.0, 180.0))});
        }
        const double altitude_m = params[6].number(io::between(-kHighest_m, kHighest_m));
        return {north_east.x(), north_east.y(),
                -(kind == kGlobal ? altitude_m - home_->altitude_m : altitude_m)};
      }
      case kLocalNed:
      case kLocalEnu: {
        local_ = true;
        const auto metres = [&](std::size_t i) {
          return params[i].number(io::between(-kHighest_m, kHighest_m));
        };
        Eigen::Vector3d given(placed ? metres(4) : 0.0, placed ? metres(5) : 0.0, metres(6));
        if (kind == kLocalEnu) given = ned_from(MissionFrame::kEnu, given);
        return placed ? given : Eigen::Vector3d(at_.x(), at_.y(), given.z());
      }
      default:
        frame.fail("is " + std::to_string(kind) +
                   ", must be 0 or 3 (global, altitude above the sea or above home), 1 (local NED) or 4 "
                   "(local ENU)");
    }
  }

  // position: in the plan.
  void require_inside(const ConfigNode& item, const Eigen::Vector3d& position) const {
    const Eigen::Vector3d position_ned = placement_.position(position);
    const control::Outcome height = control::check_height("in NED", position_ned.z(), limits_);
    if (!height.accepted) item.fail(height.reason);
    constexpr const char* kAxes[] = {"north", "east", "down"};
    for (int axis = 0; axis < 3; ++axis) {
      const double low = limits_.fence_min_ned[axis];
      const double high = limits_.fence_max_ned[axis];
      if (position_ned[axis] >= low && position_ned[axis] <= high) continue;
      item.fail(fmt::format("{} is {:.3f} m, must be inside the fence, {:g} to {:g} m", kAxes[axis],
                            position_ned[axis], low, high));
    }
  }

  std::vector<std::string> assumptions() const {
    std::vector<std::string> all;
    if (global_) {
      all.push_back(
          fmt::format("taken as a QGroundControl plan with geographic coordinates: home, {:.7f}, {:.7f} deg "
                      "and {:.1f} m, is "
                      "the origin of motion capture, north and east on its tangent plane",
                      home_->position.latitude_deg, home_->position.longitude_deg, home_->altitude_m));
    }
    if (local_)
      all.emplace_back(
          global_
              ? "local coordinates are m from there"
              : "taken as a QGroundControl plan with local coordinates: m from the origin of motion capture");
    if (takeoff_aside_m_ > kSamePlace_m)
      all.push_back(
          fmt::format("it takes off where it stands; the plan says {:.2f} m away", takeoff_aside_m_));
    if (fastest_wanted_ > 0.0)
      all.push_back(fmt::format("flown at up to {:g} m/s, the limit; the plan wants {:g} m/s",
                                limits_.max_speed, fastest_wanted_));
    if (takeoff_added_) all.emplace_back("a take-off to the height of the first waypoint is added");
    if (landing_added_) all.emplace_back("a landing is added");
    all.emplace_back(
        "it stops at each waypoint; acceptance radii, fences and rally points of the plan are ignored");
    return all;
  }

  const ConfigNode& root_;
  const control::Limits& limits_;
  const Placement& placement_;
  std::optional<Home> home_;
  std::vector<MissionItem> items_;
  Eigen::Vector3d at_ = Eigen::Vector3d::Zero();  // end of the items so far, in the plan
  double speed_ = kDefaultSpeed;
  double fastest_wanted_ = 0.0;  // m/s, largest speed above the limit; 0: none
  double takeoff_aside_m_ = 0.0;
  bool landed_ = false, takeoff_added_ = false, landing_added_ = false, global_ = false, local_ = false;
};

}  // namespace

MissionFile parse_qgroundcontrol_plan(const std::string& text, const std::string& file_name,
                                      const control::Limits& limits, const FileOptions& options) {
  const ConfigNode root = read_json(text, file_name);
  return PlanReader(root, limits, options.placement).read(file_name);
}

}  // namespace swiftlet::io
