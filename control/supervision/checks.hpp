// What a request may ask: finite, inside the fence, within the limits. Pure; run before a request reaches the
// flight controller.
#pragma once

#include "control/mission.hpp"
#include "control/request.hpp"
#include "control/settings.hpp"
#include "control/trajectory/polynomial.hpp"

namespace swiftlet::control {

Outcome accept();
// A refusal; the reason is formatted as by printf and cut at its length.
[[gnu::format(printf, 1, 2)]] Outcome refuse(const char* format, ...);

// `what` names the position in the reason: "item 3", "goto".
Outcome check_position(const char* what, const Eigen::Vector3d& position_ned, const Limits& limits);
Outcome check_speed(const char* what, double speed, const Limits& limits);

// 1 to kMaxMissionItems items; a takeoff only first, a landing only last.
Outcome check(const Mission& mission, const Limits& limits);

// 1 to kMaxTrajectorySegments segments of positive duration that join without steps in position and velocity,
// start at rest, and stay inside the fence and under the limits wherever sampled (every 50 ms or finer).
Outcome check(const Trajectory& trajectory, const Limits& limits);

}  // namespace swiftlet::control
