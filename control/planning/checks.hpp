// What a request may ask: finite, inside the fence, within the limits. Pure; run before a request reaches the
// flight controller.
#pragma once

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

Outcome accept();
// A refusal; the reason is formatted as by printf and cut at its length.
[[gnu::format(printf, 1, 2)]] Outcome refuse(const char* format, ...);

// `what` names the position in the reason: "item 3", "goto".
Outcome check_position(const char* what, const Eigen::Vector3d& position_ned, const Limits& limits);
Outcome check_speed(const char* what, double speed, const Limits& limits);

// No looser than the limits, and a fence that is one.
Outcome check(const MissionBounds& bounds, const Limits& limits);
// 1 to kMaxMissionItems items; a takeoff only first, a landing only last. Each of its trajectories as
// below. By its own bounds, which check() finds no looser than the settings' limits.
Outcome check(const Mission& mission, const Limits& settings);

// 1 to kMaxTrajectorySegments segments as check_segment() has them, that join without steps in position and
// velocity and start at rest.
Outcome check(const Trajectory& trajectory, const Limits& limits);

// A positive duration, an hour at most, finite coefficients, and check_motion().
Outcome check_segment(const char* what, const PolynomialSegment& segment, const Limits& limits);

// Inside the fence and under the limits of speed and acceleration everywhere, as bounds of the polynomials
// show.
Outcome check_motion(const char* what, const PolynomialSegment& segment, const Limits& limits);

// That `next` begins where `before` ends, to kJoin_m and kJoin_m_s.
constexpr double kJoin_m = 1e-3;
constexpr double kJoin_m_s = 1e-2;
Outcome check_joint(const char* what, const PolynomialSegment& before, const PolynomialSegment& next);
// That a trajectory's first segment begins at rest, to kJoin_m_s.
Outcome check_start(const char* what, const PolynomialSegment& first);

}  // namespace swiftlet::control
