// The reference path of each phase of flight: take-off, moves, stops, landings, and the items and segments of
// a plan one after another.
#pragma once

#include "swiftlet/control/guidance/braking_manoeuvre.hpp"
#include "swiftlet/control/guidance/guidance_context.hpp"

namespace swiftlet::control {

constexpr double kAirborneHeight_m = 0.03;  // above the ground

// Moves the reference to the nearest place inside the fence: what joins one motion to another may swing
// out. Down to the ground the fence does not matter.
void clamp_to_fence(const Limits& limits, Reference& reference);

// Where the estimate is, at rest, with its yaw.
Reference standing_at(const Estimate& estimate);

// How a reference that moves so comes to rest within the limits of references, as start_stop() would have it
// without a fence.
BrakingManoeuvre brake_reference(const Limits& limits, const Reference& from);
// Likewise one that was put where the vehicle is, as it moves: braked by three quarters of the limit at most,
// since the loops must follow first. Its acceleration is what the thrust gives now, and goes with the
// attitude.
BrakingManoeuvre brake_vehicle(const Limits& limits, const Reference& from);

// Spool up, then climb straight to that height.
void start_takeoff(const GuidanceContext& context, double to_z_ned, double speed);
// From the reference as it is at start_ns, straight to a place; a vehicle in motion gets there by a quintic.
void start_move(const GuidanceContext& context, const Eigen::Vector3d& to_ned, bool yaw_free, double yaw_rad,
                double speed, std::int64_t start_ns);
// From the reference as it is at start_ns into the start of a trajectory: position, velocity, acceleration
// and jerk go over without a step; of the yaw not, with keep_yaw. Where no such way stays inside the fence
// and the limits, as start_move(). Its segments follow from the first on.
void start_join(const GuidanceContext& context, const PolynomialSegment& first, bool keep_yaw, double speed,
                std::int64_t start_ns);
// Comes to rest along the present velocity, inside the fence.
void start_stop(const GuidanceContext& context);
// Comes to rest inside the fence on the way down, then sinks until the ground is felt.
void start_landing(const GuidanceContext& context, double speed, std::int64_t start_ns);
// The item that the mission's progress names.
void start_item(const GuidanceContext& context, std::int64_t start_ns);

// Of a mission that is being flown: its time comes to a stand, or runs on again, as smoothly as the limits
// want it. The vehicle stays on its way.
void change_time_scaling(const GuidanceContext& context, bool to_running);
// Before a paused mission's vehicle is sent elsewhere: remembers where it was.
void pause_path(const GuidanceContext& context);
// To where the paused mission was left, and on from there.
void return_to_paused_path(const GuidanceContext& context);

// To the phase, item or segment whose time has come.
void advance(const GuidanceContext& context);
// What the vehicle is to do now: where it stands, on the ground; in flight the place on its path, inside the fence.
Reference reference(const GuidanceContext& context);
// Nothing is left to fly of a take-off, mission or trajectory.
bool plan_finished(const GuidanceContext& context);
// The item being flown is the mission's landing.
bool on_landing_item(const GuidanceContext& context);

// Of the level descent without position. Where dead reckoning says that the vehicle must be standing, twice
// failsafe.descent_speed: one that stands on thrust that carries its weight feels no ground, less thrust
// shows it.
double blind_descent_speed(const GuidanceContext& context);

// Of the thrust while spooling up, of the weight.
double spool_up_lift(const GuidanceContext& context);

}  // namespace swiftlet::control
