// Checks of requests: values are finite, inside the fence, within the limits. Pure functions, run before a
// request reaches the flight controller.
#pragma once

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

Outcome accept();
// A refusal. The reason is formatted as by printf and truncated to its size.
[[nodiscard, gnu::format(printf, 1, 2)]] Outcome refuse(const char* format, ...);

// `what` names the position in the reason: "item 3", "goto".
// Where a setpoint may lead: finite, check_height(), check_inside_fence().
Outcome check_position(const char* what, const Eigen::Vector3d& position_ned, const Limits& limits);
Outcome check_inside_fence(const char* what, const Eigen::Vector3d& position_ned, const Limits& limits);
// At least limits.min_height_m above the ground. The reason for a z below the ground says which height it is
// and which z the same height above the ground is.
Outcome check_height(const char* what, double z_ned, const Limits& limits);
// The same for a vehicle whose minimum height is not known: not below the ground.
Outcome check_above_ground(const char* what, double z_ned);
// Finite, and within a full turn, above which degrees are suspected.
Outcome check_yaw(const char* what, double yaw_rad);
Outcome check_speed(const char* what, double speed, const Limits& limits);

// The bounds are no looser than the limits, and the fence's maximum is above its minimum. A fence that reaches
// lower than that of the limits, such as below the ground, is accepted: the higher end applies.
Outcome check(const MissionBounds& bounds, const Limits& limits);
// 1 to kMaxMissionItems items, a takeoff only first, a landing only last, each trajectory as below. Checked
// against the settings' limits as tightened by the mission's bounds, which must pass check() themselves.
Outcome check(const Mission& mission, const Limits& settings);

// 1 to kMaxTrajectorySegments segments that pass check_segment(), without steps in position and velocity
// between them, from rest to rest.
Outcome check(const Trajectory& trajectory, const Limits& limits);

// Duration above 0 and at most an hour, finite coefficients, and check_motion().
Outcome check_segment(const char* what, const PolynomialSegment& segment, const Limits& limits);

// Inside the fence, above the minimum height, and below the limits of speed and acceleration, everywhere:
// checked by bounds of the polynomials.
Outcome check_motion(const char* what, const PolynomialSegment& segment, const Limits& limits);

// `next` starts where `before` ends, to within kJoin_m and kJoin_m_s.
constexpr double kJoin_m = 1e-3;
constexpr double kJoin_m_s = 1e-2;
Outcome check_joint(const char* what, const PolynomialSegment& before, const PolynomialSegment& next);
// A trajectory's first segment starts at rest, and its last one ends there, to within kJoin_m_s and kRest_rad_s: before and after it the
// vehicle stands in the air.
constexpr double kRest_rad_s = 0.1;
Outcome check_start(const char* what, const PolynomialSegment& first, bool yaw_free = false);
Outcome check_end(const char* what, const PolynomialSegment& last, bool yaw_free = false);

}  // namespace swiftlet::control
