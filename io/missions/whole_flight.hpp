// Common parts of the readers of other projects' formats: ENU to NED, and a complete flight around a path.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "swiftlet/control/planning/waypoint_path.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/missions/mission_format.hpp"

namespace swiftlet::ground {

control::PolynomialSegment ned_segment(const control::PolynomialSegment& segment_enu);

constexpr double kHoverHeight_m = 1.0;  // lowest point of a path that was raised
constexpr double kLeastHeight_m = 0.2;  // a path with a lower point is raised
constexpr double kApproachSpeed =
    0.5;  // m/s, largest speed of take-off, of the flight to the start of the path, and of landing

// Returns by how much a path must be raised, m; 0 if it stays above kLeastHeight_m. Adds the decision to the
// assumptions.
double raise_by(double least_height_m, std::vector<std::string>& assumptions);

// Returns the path if it can be flown. Calls `where`, which must throw, with the index of the first segment
// that violates the fence or the limits or does not continue the previous segment, and with the reason.
TrajectoryFile checked(TrajectoryFile path, const control::Limits& limits,
                       const std::function<void(std::size_t, const std::string&)>& where);

// Returns take-off to the height of the path's start, the path, and landing.
MissionFile whole_flight(const std::string& file_name, TrajectoryFile path, const control::Limits& limits);

// Returns the least height above z = 0 along the path, m.
double least_height(const std::vector<control::PolynomialSegment>& segments);

control::MotionLimits reference_limits(const control::Limits& limits);

}  // namespace swiftlet::ground
