// The manoeuvres: the reference path of each phase of flight (moves, stops, landings), and the
// sequence of a plan's items and segments.
#pragma once

#include "swiftlet/control/guidance/braking_manoeuvre.hpp"
#include "swiftlet/control/guidance/guidance_context.hpp"

namespace swiftlet::control {

constexpr double kAirborneHeight_m = 0.03;  // m above the ground

// Moves the reference to the nearest position inside the fence, because the join of two motions may leave
// it. The fence's lower end (maximum z) is not enforced, so that landings reach the ground.
void clamp_to_fence(const Limits& limits, Reference& reference);

// The reference of the present path at a time, raised to the minimum height, or to the lower end of the path's
// segment if that is lower.
Reference reference_on_path(const GuidanceContext& context, std::int64_t at_ns);

// The limits for a path from z_ned: from below the minimum height, a path may be as low as it starts.
Limits limits_from(const Limits& limits, double z_ned);

// A reference at rest at the estimated position and yaw.
Reference standing_at(const Estimate& estimate);

// The braking manoeuvre of a moving reference, within the limits of references: that of start_stop() without
// a fence.
BrakingManoeuvre brake_reference(const Limits& limits, const Reference& from);
// The same for a reference that starts at the vehicle's own motion. Its peak is three quarters of the
// acceleration limit, since the loops must follow first. It ignores the present acceleration, which depends
// on the attitude and changes with it.
BrakingManoeuvre brake_vehicle(const Limits& limits, const Reference& from);
// The manoeuvre with its stopping point moved inside the fence and up to the minimum height, and with the
// time that the ascent takes.
BrakingManoeuvre inside_fence(const Limits& limits, const Reference& from, BrakingManoeuvre stop);

// Moves from the reference at start_ns to a position: straight from rest, by a quintic from motion. The path
// is nowhere lower than the minimum height, or the lower of its ends if that is lower.
void start_move(const GuidanceContext& context, const Eigen::Vector3d& to_ned, bool yaw_free, double yaw_rad,
                double speed, std::int64_t start_ns);
// Joins a trajectory from the reference at start_ns: position, velocity, acceleration and jerk are
// continuous, and with keep_yaw = false yaw is too. Where no join stays inside the fence and the limits,
// moves as start_move() does. The trajectory's segments follow from the first on.
void start_join(const GuidanceContext& context, const PolynomialSegment& first, bool keep_yaw, double speed,
                std::int64_t start_ns);
// Brakes along the present velocity, inside the fence and above the minimum height: from below it, ascends.
void start_stop(const GuidanceContext& context);
// Brakes inside the fence while it descends, then sinks until touchdown is detected.
void start_landing(const GuidanceContext& context, double speed, std::int64_t start_ns);
// Starts the item that the mission's progress names.
void start_item(const GuidanceContext& context, std::int64_t start_ns);

// Time scaling of a mission being flown: the path's time slows to a stop, or starts to run again, within the
// limits. The vehicle stays on its path.
void change_time_scaling(const GuidanceContext& context, bool to_running);
// Stores the path and its time before a paused mission's vehicle is sent elsewhere.
void pause_path(const GuidanceContext& context);
// Returns to the point where the mission was paused and resumes it.
void return_to_paused_path(const GuidanceContext& context);

// Moves on to the next phase, item or segment once it is due.
void advance(const GuidanceContext& context);
// The reference now: at rest at the estimate on the ground; on the path and inside the fence in flight.
Reference reference(const GuidanceContext& context);
// True once the take-off, mission or trajectory of the present mode is finished.
bool plan_finished(const GuidanceContext& context);
// True while the mission's landing item is flown.
bool on_landing_item(const GuidanceContext& context);

// Speed of the level descent without position, m/s: failsafe.descent_speed, and twice that once dead
// reckoning is below the ground. A vehicle that stands while its thrust carries its weight shows no
// touchdown; less thrust makes it show.
double blind_descent_speed(const GuidanceContext& context);

}  // namespace swiftlet::control
