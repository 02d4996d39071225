// The conditions of a step, each compared with its threshold.
#pragma once

#include "swiftlet/control/supervision/events.hpp"
#include "swiftlet/control/supervision/supervisor_context.hpp"

namespace swiftlet::control {

// The conditions that hold. The state keeps the start times of those that must hold for some time.
// tip_over_cosine: tip_over_cosine() of the settings, computed once.
EventSet observe(SupervisorContext& context, double tip_over_cosine);

// Cosine of the tilt at which the vehicle has tipped over.
double tip_over_cosine(const FailsafeSettings& failsafe);

// Distance outside the fence along the worst axis, m; negative inside.
double beyond_fence(const Limits& limits, const Eigen::Vector3d& position_ned);

bool pose_lost(const SupervisorInputs& inputs, const FailsafeSettings& failsafe);
// True if a client whose link-loss failsafe is on has been silent for too long.
bool ground_link_lost(const SupervisorState& state, const FailsafeSettings& failsafe);
// Switches the link-loss failsafe off for clients that have been silent for too long.
void forget_silent_ground_links(SupervisorState& state, const FailsafeSettings& failsafe);

}  // namespace swiftlet::control
