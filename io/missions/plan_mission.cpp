#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <tuple>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "swiftlet/io/column.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/missions/plan.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"
#include "swiftlet/math/geodesy.hpp"

namespace swiftlet::io {
namespace {

using control::MissionItem;
using control::MissionItemKind;

constexpr double kHomeTolerance_m = 0.1;
constexpr double kGroundTolerance_m = 0.1;  // of the height of a landing
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

// What becomes of a parameter: it is read, must be 0 or empty, or has no meaning for a multirotor.
enum class Use { kRead, kUnset, kAeroplane };
constexpr Use kRead = Use::kRead, kUnset = Use::kUnset, kAeroplane = Use::kAeroplane;

struct Command {
  int number;
  const char* name;
  std::array<Use, 7> parameters;
};
// The table in docs/other-formats.md says what each of them is.
constexpr Command kCommands[] = {
    {kWaypoint, "waypoint", {kRead, kRead, kUnset, kRead, kRead, kRead, kRead}},
    {kLoiterTime, "loiter for a time", {kRead, kAeroplane, kAeroplane, kAeroplane, kRead, kRead, kRead}},
    {kReturnToLaunch, "return to launch", {kUnset, kUnset, kUnset, kUnset, kUnset, kUnset, kUnset}},
    {kLand, "land", {kUnset, kUnset, kUnset, kUnset, kRead, kRead, kRead}},
    {kTakeoff, "take-off", {kAeroplane, kUnset, kUnset, kUnset, kRead, kRead, kRead}},
    {kChangeSpeed, "change speed", {kRead, kRead, kRead, kUnset, kUnset, kUnset, kUnset}},
};

std::string title_of(const Command& command) { return fmt::format("{} ({})", command.number, command.name); }

const Command& command_of(const PlanItem& item) {
  const int number = item.command.integer(65535);
  const auto* const found = std::find_if(std::begin(kCommands), std::end(kCommands),
                                         [&](const Command& known) { return known.number == number; });
  if (found != std::end(kCommands)) return *found;
  std::vector<std::string> titles;
  for (const Command& known : kCommands) titles.push_back(title_of(known));
  item.command.place.fail("is " + std::to_string(number) + ", must be " + one_of(titles));
}

constexpr int kGlobal = 0;
constexpr int kLocalNed = 1;
constexpr int kGlobalRelative = 3;
constexpr int kLocalEnu = 4;

struct Home {
  math::GeographicPosition position;
  double altitude_m = 0.0;
};

class PlanReader {
 public:
  PlanReader(const Plan& plan, const control::Limits& limits, const Placement& placement)
      : plan_(plan), limits_(limits), placement_(placement) {}

  MissionFile read() {
    if (plan_.home) read_home(*plan_.home);
    set_speed(kDefaultSpeed);
    for (const PlanItem& item : plan_.items) read_item(item);
    complete();
    MissionFile file;
    file.name = std::filesystem::path(plan_.place.file).stem().string();
    file.tolerance_m = kHomeTolerance_m;
    file.mission.items = std::move(items_);
    file.assumptions = assumptions();
    return file;
  }

 private:
  void read_home(const std::array<PlanNumber, 3>& values) {
    home_ = Home{{values[0].number(io::between(-90.0, 90.0)), values[1].number(io::between(-180.0, 180.0))},
                 values[2].number(io::between(-kHighest_m, kHighest_m))};
  }

  void set_speed(double wanted) {
    speed_ = std::min(wanted, limits_.max_speed);
    if (speed_ < wanted) fastest_wanted_ = std::max(fastest_wanted_, wanted);
  }

  void read_item(const PlanItem& item) {
    if (landed_) item.place.fail("follows a landing, which must be the last item");
    const Command& command = command_of(item);
    refuse_unread(item, command);
    switch (command.number) {
      case kTakeoff:
        return add_takeoff(item);
      case kLand:
        return add_landing(item);
      case kReturnToLaunch:
        need_height(item);
        return land_at(item, {0.0, 0.0});
      case kChangeSpeed:
        return change_speed(item);
      default:
        return add_waypoint(item, command.number == kWaypoint);
    }
  }

  void refuse_unread(const PlanItem& item, const Command& command) {
    for (std::size_t i = 0; i < command.parameters.size(); ++i) {
      const PlanNumber& parameter = item.params[i];
      if (command.parameters[i] == kRead || parameter.value.value_or(0.0) == 0.0) continue;
      const std::string title = fmt::format("{} of {}", i + 1, title_of(command));
      if (command.parameters[i] == kUnset)
        parameter.place.fail(fmt::format("is {}, must be 0 or empty: parameter {} is not read",
                                         exact(*parameter.value), title));
      if (std::find(for_aeroplanes_.begin(), for_aeroplanes_.end(), title) == for_aeroplanes_.end())
        for_aeroplanes_.push_back(title);
    }
  }

  void change_speed(const PlanItem& item) {
    const auto& [kind, speed, throttle] = std::tie(item.params[0], item.params[1], item.params[2]);
    if (const double value = kind.value.value_or(1.0); value != 0.0 && value != 1.0)
      kind.place.fail(fmt::format(
          "is {}, must be 0 or 1, a speed of flight: a speed of climb or descent is not read", exact(value)));
    if (const double value = throttle.value.value_or(-1.0); value != -1.0 && value != 0.0)
      throttle.place.fail(fmt::format("is {}, must be -1, 0 or empty: a throttle is not read", exact(value)));
    if (speed.value == -1.0) return;  // no change
    set_speed(speed.value == -2.0 ? kDefaultSpeed : speed.number(io::above(0.0)));
  }

  void add_takeoff(const PlanItem& item) {
    if (!items_.empty()) item.place.fail("is a take-off, which must be the first item");
    const Eigen::Vector3d place = position(item, true);
    const double aside_m = place.head<2>().norm();
    if (aside_m > kTakeoffPlace_m) {
      item.place.fail(
          fmt::format("takes off {:.1f} m from home, must be at most {:.0f} m: the vehicle stands at home",
                      aside_m, kTakeoffPlace_m));
    }
    require_inside(item, {0.0, 0.0, place.z()});
    takeoff_aside_m_ = aside_m;
    add({MissionItemKind::kTakeoff, {0.0, 0.0, place.z()}, 0.0, true, speed_, 0.0});
  }

  // Parameters 2 and 4 are those of a waypoint.
  void add_waypoint(const PlanItem& item, bool has_all) {
    MissionItem waypoint;
    waypoint.kind = MissionItemKind::kWaypoint;
    waypoint.position_ned = position(item, false);
    require_inside(item, waypoint.position_ned);
    waypoint.speed = speed_;
    if (item.params[0].value) waypoint.hold_s = item.params[0].number(io::between(0.0, kLongestHold_s));
    if (has_all && item.params[1].value)
      waypoint.acceptance_radius_m = item.params[1].number(io::at_least(0.0));
    if (has_all && item.params[3].value) {
      waypoint.yaw_free = false;
      waypoint.yaw_rad =
          std::remainder(item.params[3].number(io::between(-360.0, 360.0)) * M_PI / 180.0, 2.0 * M_PI);
    }
    need_takeoff(waypoint.position_ned.z());
    add(waypoint);
  }

  void add_landing(const PlanItem& item) {
    need_height(item);
    const bool somewhere = item.params[4].value && item.params[5].value;
    const PlanNumber& height = item.params[6];
    if (!somewhere && height.value.value_or(0.0) == 0.0) return land_at(item, at_.head<2>());
    const Eigen::Vector3d place = position(item, true);
    if (std::abs(place.z()) > kGroundTolerance_m)
      height.place.fail(
          fmt::format("is {:g} m above home, must be within {:g} m: the vehicle lands on the ground",
                      -place.z(), kGroundTolerance_m));
    land_at(item, place.head<2>());
  }

  // Flies to a place at the present height, then lands straight down.
  void land_at(const PlanItem& item, const Eigen::Vector2d& place) {
    const Eigen::Vector3d above(place.x(), place.y(), at_.z());
    require_inside(item, above);
    if ((above - at_).norm() > kSamePlace_m) add({MissionItemKind::kWaypoint, above, 0.0, true, speed_, 0.0});
    add({MissionItemKind::kLand, Eigen::Vector3d::Zero(), 0.0, true, speed_, 0.0});
    landed_ = true;
  }

  void need_height(const PlanItem& item) const {
    if (items_.empty()) item.place.fail("is the first item, must follow a take-off or a waypoint");
  }
  void need_takeoff(double z_ned) {
    if (!items_.empty()) return;
    add({MissionItemKind::kTakeoff, {0.0, 0.0, z_ned}, 0.0, true, speed_, 0.0});
    takeoff_added_ = true;
  }
  void complete() {
    if (items_.empty()) plan_.items_place.fail("has no item to fly, must have a take-off or a waypoint");
    if (landed_) return;
    add({MissionItemKind::kLand, Eigen::Vector3d::Zero(), 0.0, true, speed_, 0.0});
    landing_added_ = true;
  }

  void add(const MissionItem& item) {
    if (items_.size() == control::kMaxMissionItems)
      plan_.items_place.fail(
          fmt::format("has more than {} items with those added", control::kMaxMissionItems));
    MissionItem placed = item;
    placed.position_ned = placement_.position(item.position_ned);
    if (!item.yaw_free) placed.yaw_rad = std::remainder(placement_.yaw(item.yaw_rad), 2.0 * M_PI);
    items_.push_back(placed);
    if (item.kind != MissionItemKind::kLand) at_ = item.position_ned;
  }

  // Returns the position in the plan: in NED from home, m. Take-offs and landings may omit the horizontal position. In
  // geographic coordinates, Mission Planner and ArduPilot write 0, 0 for "here".
  Eigen::Vector3d position(const PlanItem& item, bool place_optional) {
    const std::vector<PlanNumber>& params = item.params;
    const int kind = item.frame.integer(255);
    const bool here =
        (kind == kGlobal || kind == kGlobalRelative) && params[4].value == 0.0 && params[5].value == 0.0;
    const bool placed = !here && (!place_optional || (params[4].value && params[5].value));
    if (here) here_.push_back(std::to_string(&item - plan_.items.data() + 1));
    switch (kind) {
      case kGlobal:
      case kGlobalRelative: {
        if (!home_)
          plan_.place.fail("has items with geographic coordinates, must have a plannedHomePosition");
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
        item.frame.place.fail(
            "is " + std::to_string(kind) +
            ", must be 0 or 3 (global, altitude above the sea or above home), 1 (local NED) or 4 "
            "(local ENU)");
    }
  }

  // position: in the plan.
  void require_inside(const PlanItem& item, const Eigen::Vector3d& position) const {
    const MissionFrame frame = item.frame.value == kLocalNed ? MissionFrame::kNed : MissionFrame::kEnu;
    const std::string fault = position_fault(placement_.position(position), frame, limits_);
    if (!fault.empty()) item.place.fail(fault);
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
    if (!here_.empty())
      all.push_back(fmt::format("latitude and longitude 0 of item{} {} mean here",
                                here_.size() > 1 ? "s" : "", one_of(here_, " and ")));
    if (!for_aeroplanes_.empty())
      all.push_back(fmt::format("for aeroplanes, not used: parameter {}", fmt::join(for_aeroplanes_, ", ")));
    if (plan_.estimates_speed)
      all.push_back(fmt::format(
          "hoverSpeed and cruiseSpeed of the plan are for the estimate of QGroundControl: it flies at {:g} "
          "m/s, and at the speeds of its commands",
          std::min(kDefaultSpeed, limits_.max_speed)));
    if (fastest_wanted_ > 0.0)
      all.push_back(fmt::format("flown at up to {:g} m/s, the limit; the plan wants {:g} m/s",
                                limits_.max_speed, fastest_wanted_));
    if (takeoff_added_) all.emplace_back("a take-off to the height of the first waypoint is added");
    if (landing_added_) all.emplace_back("a landing is added");
    all.emplace_back("it stops at each waypoint; fences and rally points of the plan are ignored");
    return all;
  }

  const Plan& plan_;
  const control::Limits& limits_;
  const Placement& placement_;
  std::optional<Home> home_;
  std::vector<MissionItem> items_;
  Eigen::Vector3d at_ = Eigen::Vector3d::Zero();  // end of the items so far, in the plan
  double speed_ = kDefaultSpeed;
  double fastest_wanted_ = 0.0;  // m/s, largest speed above the limit; 0: none
  double takeoff_aside_m_ = 0.0;
  std::vector<std::string> here_;            // numbers of items at latitude and longitude 0
  std::vector<std::string> for_aeroplanes_;  // parameters without effect
  bool landed_ = false, takeoff_added_ = false, landing_added_ = false, global_ = false, local_ = false;
};

}  // namespace

MissionFile mission_of(const Plan& plan, const control::Limits& limits, const Placement& placement) {
  return PlanReader(plan, limits, placement).read();
}

}  // namespace swiftlet::io
