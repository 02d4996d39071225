// Lines about the state of a vehicle, for terminals and other output.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <nlohmann/json_fwd.hpp>

#include "swiftlet/ground/client/silence.hpp"
#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::ground {

// [{"who": "vehicle", "for_s": 3.2}, ...]; for_s is null if nothing has come at all.
nlohmann::ordered_json to_json(const std::vector<Silence>& silences);

// Prints the line, bold and red if the stream is a terminal.
void print_alarm(std::FILE* stream, const std::string& line);

// 0 .. 360, clockwise from north, rounded to a tenth.
double heading_deg(const Eigen::Quaterniond& q_ned_from_frd);

// "roll 1.2, pitch -0.4, heading 90.0 deg": Euler angles of the estimate, Eq. (3); heading from north to
// east, 0 to 360.
std::string attitude_text(const messages::msg::Estimate& estimate);

// How far the vehicle's own estimate is from that of motion capture, and which of both flies; empty for a vehicle without one.
std::string odometry_text(const messages::msg::ControlStatus& control);

}  // namespace swiftlet::ground
