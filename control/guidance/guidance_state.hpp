// The state of guidance between steps, as plain data.
#pragma once

#include <array>
#include <cstdint>

#include "swiftlet/control/guidance/reference_path.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/request.hpp"

namespace swiftlet::control {

// The phase of flight, whatever the mode.
enum class Phase : std::uint8_t {
  kGround = 0,
  kSpoolUp = 1,  // on the ground, thrust rises
  kPath = 2,     // along the reference path
  kSink = 3,     // last part of a landing: descends until touchdown is detected
};

// Whether a paused mission's vehicle has left the mission's path.
enum class MissionPause : std::uint8_t {
  kNone = 0,
  kAway = 1,       // it was sent elsewhere
  kReturning = 2,  // it returns to the point of the pause
};

// The path at which a mission was paused, and the path's time then, to resume it.
struct PausedPath {
  PolynomialSegment segment;
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::int64_t at_ns = 0;
};

// The setpoint of a stream of attitudes or body rates, with the fields of Setpoint.
struct DirectSetpoint {
  std::array<double, 4> q_ned_from_frd{1.0, 0.0, 0.0, 0.0};  // w, x, y, z
  std::array<double, 3> body_rates_frd{};                    // rad/s
  double specific_thrust = 0.0;                              // m/s^2
};

// The state of guidance. Times are stamps of the vehicle's clock, ns.
struct GuidanceState {
  Phase phase = Phase::kGround;
  std::int64_t phase_since_ns = 0;
  bool airborne = false;

  ReferencePath path;
  double climb_to_z_ned = 0.0;  // m, target of the present take-off
  double climb_speed = 0.5;     // m/s
  double ground_z_ned = 0.0;    // m, ground height when it was armed

  MissionProgress mission;                   // its item index is the item being flown
  std::int64_t item_end_ns = 0;              // end of the item's path and hold, in path time; 0: not arrived
  MissionPause pause = MissionPause::kNone;  // of a mission that is paused or returns to its path
  PausedPath paused_path;                    // valid unless pause is kNone
  std::uint64_t trajectory_id = 0;           // of the one being flown
  std::uint32_t next_segment = 0;            // index of the next segment of that trajectory

  std::int64_t setpoint_ns = 0;  // stamp of the last accepted one
  SetpointKind setpoint_kind = SetpointKind::kPosition;
  DirectSetpoint direct;  // of the kinds that bypass the position loop

  bool flying() const { return phase != Phase::kGround; }
  bool mission_paused() const { return mission.state == MissionState::kPaused; }
};

}  // namespace swiftlet::control
