// The take-off until the vehicle is clear of the ground: the thrust rises while it stands, then the climb begins.
#pragma once

#include "swiftlet/control/guidance/guidance_context.hpp"

namespace swiftlet::control {

// Idles until start_ns, spools up, then climbs vertically to to_z_ned.
void start_takeoff(const GuidanceContext& context, double to_z_ned, double speed, std::int64_t start_ns);
// A vehicle with an arming of its own starts its rotors later than it is told to.
void await_rotors(const GuidanceContext& context);
// The spool-up ends after its time. Where lift-off is observed, the vehicle then rises until it is clear of the
// ground, and the climb begins with its own motion above the place where it left the ground: wind may have pushed it while
// its legs carried little. It begins on time, also between two steps, if the vehicle was clear by then: vehicles that start
// together climb together.
void advance_spool_up(const GuidanceContext& context);
// Thrust during spool-up, as a fraction of the weight.
double spool_up_lift(const GuidanceContext& context);

}  // namespace swiftlet::control
