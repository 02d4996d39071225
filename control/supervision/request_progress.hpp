// Tracks accepted requests to their end: executing, succeeded, canceled by a newer request, or aborted by a
// failsafe.
//
// arm, disarm, stop, mission upload and mission clear succeed when they are accepted. takeoff, goto, hold
// and mission pause succeed when the reference rests and the vehicle is there; land succeeds on the ground;
// a trajectory at its end; mission start, resume and skip when the mission is completed, whatever pauses
// come before; a change of gains when the new ones are in force.
#pragma once

#include "swiftlet/control/supervision/request_status.hpp"
#include "swiftlet/control/supervision/supervisor_context.hpp"
#include "swiftlet/control/supervision/transitions.hpp"

namespace swiftlet::control {

// The vehicle counts as at a resting reference below these distances and speeds.
constexpr double kThere_m = 0.05;
constexpr double kStandstill_m_s = 0.1;

// Stores context.request, which was accepted and whose row was taken. Replaces the oldest finished request,
// or else the oldest.
void note_accepted(SupervisorContext& context);

// Ends the requests that this row ends; the row is that of a condition or a request.
void end_requests(SupervisorContext& context, const Transition& row);

// Updates state and success in each step, after its row. Progress, which only reports show, is computed where it is due.
void follow_requests(SupervisorContext& context, const Reference& reference, bool progress_due);

}  // namespace swiftlet::control
