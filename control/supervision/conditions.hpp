// The conditions of a step, each against its threshold.
#pragma once

#include "swiftlet/control/supervision/events.hpp"
#include "swiftlet/control/supervision/supervisor_context.hpp"

namespace swiftlet::control {

// Which of them hold. Keeps in the state since when those hold that must last for a while.
// tip_over_cosine: tip_over_cosine() of the settings, which no step works out anew.
EventSet observe(SupervisorContext& context, double tip_over_cosine);

// Of the tilt at which the vehicle has tipped over.
double tip_over_cosine(const FailsafeSettings& failsafe);

// How far outside the fence, along the axis where it is farthest, m; negative inside.
double beyond_fence(const Limits& limits, const Eigen::Vector3d& position_ned);

bool pose_lost(const SupervisorInputs& inputs, const FailsafeSettings& failsafe);
// Some ground tool that the flight depends on has been silent for too long.
bool ground_link_lost(const SupervisorState& state, const FailsafeSettings& failsafe);
// Those that have been silent for too long are not waited for any more.
void forget_silent_ground_links(SupervisorState& state, const FailsafeSettings& failsafe);

}  // namespace swiftlet::control
