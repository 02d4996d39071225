// What the formats of others have in common: ENU, and a flight around a path.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "swiftlet/control/planning/waypoint_path.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/missions/mission_format.hpp"

namespace swiftlet::ground {

Eigen::Vector3d ned_position(const Eigen::Vector3d& position_enu);
// ENU yaw is counter-clockwise from east, NED yaw clockwise from north.
double ned_yaw(double yaw_enu);
control::PolynomialSegment ned_segment(const control::PolynomialSegment& segment_enu);

constexpr double kHoverHeight_m = 1.0;  // above which a path is flown that says nothing of the ground
constexpr double kLeastHeight_m = 0.2;  // a path that comes lower is taken for one of these
constexpr double kApproachSpeed =
    0.5;  // m/s, of take-off, to where the path begins, and of the landing at most

// By how much a path must be raised, m; 0 if it stays above kLeastHeight_m. Adds to the assumptions what was
// decided.
double raise_by(double least_height_m, std::vector<std::string>& assumptions);

// The path, if it can be flown. `where` throws for the segment of this index with a sentence about it, for
// one that breaks fence, limits or the one before it.
TrajectoryFile checked(TrajectoryFile path, const control::Limits& limits,
                       const std::function<void(std::size_t, const std::string&)>& where);

// Take-off to the height where the path begins, the path, the landing.
MissionFile whole_flight(const std::string& file_name, TrajectoryFile path, const control::Limits& limits);

// The least height above z = 0 along the path, m.
double least_height(const std::vector<control::PolynomialSegment>& segments);

control::MotionLimits reference_limits(const control::Limits& limits);

}  // namespace swiftlet::ground
