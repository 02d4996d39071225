// Follows the requests that were accepted to their end: which of them goes on, and which has succeeded, was
// canceled by a newer request or aborted by a failsafe.
//
// arm, disarm, stop, mission upload and mission clear have succeeded when they are accepted. takeoff, goto, hold and
// mission pause have when the reference rests and the vehicle is there; land on the ground; a trajectory at its end;
// mission start, resume and skip when the mission is completed, whatever pauses come before that.
#pragma once

#include "swiftlet/control/supervision/request_status.hpp"
#include "swiftlet/control/supervision/supervisor_context.hpp"
#include "swiftlet/control/supervision/transitions.hpp"

namespace swiftlet::control {

// The vehicle is with a reference that rests.
constexpr double kThere_m = 0.05;
constexpr double kStandstill_m_s = 0.1;

// scene.request was accepted and its row taken. What is over makes room for it, the oldest first.
void note_accepted(SupervisorContext& context);

// This row was taken, of a condition or a request: ends the requests that it ends.
void end_requests(SupervisorContext& context, const Transition& row);

// In each step, after its row: their progress, and whether they have succeeded.
void follow_requests(SupervisorContext& context, const Reference& reference);

}  // namespace swiftlet::control
