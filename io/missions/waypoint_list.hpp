// Lists of waypoints of QGroundControl, Mission Planner and MAVProxy: "QGC WPL 110", then a line for each item,
// index, current, frame, command, four parameters, latitude or x, longitude or y, altitude or z, autocontinue. The
// first is the home position. https://mavlink.io/en/file_formats/#mission_plain_text_file
#pragma once

#include <string>
#include <string_view>

namespace swiftlet::io {

bool is_waypoint_list(std::string_view text);

// The same as a .plan document, line by line. Throws io::ConfigError.
std::string plan_of_waypoint_list(const std::string& text, const std::string& file_name);

}  // namespace swiftlet::io
