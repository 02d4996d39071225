// Missions of QGroundControl.
//
// Plans: JSON, https://docs.qgroundcontrol.com/master/en/qgc-dev-guide/file_formats/plan.html.
// Lists of waypoints, also of Mission Planner and MAVProxy: "QGC WPL 110", then a line for each item, index, current,
// frame, command, four parameters, latitude or x, longitude or y, altitude or z, autocontinue. The first is the home
// position. https://mavlink.io/en/file_formats/#mission_plain_text_file
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/io/config.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/missions/placement.hpp"

namespace swiftlet::io {

// Where a part of a plan stands, for messages.
struct PlanPlace {
  std::string file;
  int line = 0;
  std::string key;

  // Throws ConfigError.
  [[noreturn]] void fail(const std::string& message) const;
};

// A number of a plan; none for JSON's null. Both functions throw ConfigError for another or for none.
struct PlanNumber {
  PlanPlace place;
  std::optional<double> value;

  double number(const Bounds& bounds) const;
  int integer(int most) const;  // from 0
};

// A command of MAVLink, https://mavlink.io/en/messages/common.html.
struct PlanItem {
  PlanPlace place;
  PlanNumber command;              // MAV_CMD
  PlanNumber frame;                // MAV_FRAME
  std::vector<PlanNumber> params;  // 7
};

struct Plan {
  PlanPlace place, items_place;
  std::optional<std::array<PlanNumber, 3>> home;  // latitude and longitude, deg, and altitude, m
  bool estimates_speed = false;  // hoverSpeed, with which QGroundControl estimates the duration
  std::vector<PlanItem> items;
};

bool is_waypoint_list(std::string_view text);

// Both throw ConfigError.
Plan plan_of_json(const std::string& text, const std::string& file_name);
Plan plan_of_waypoint_list(const std::string& text, const std::string& file_name);

// The flight of a plan. Throws ConfigError for a plan that cannot be flown within the limits.
MissionFile mission_of(const Plan& plan, const control::Limits& limits, const Placement& placement);

}  // namespace swiftlet::io
