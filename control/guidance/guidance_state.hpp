// What guidance remembers from one step to the next, as plain data.
#pragma once

#include <array>
#include <cstdint>

#include "swiftlet/control/guidance/reference_path.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/request.hpp"

namespace swiftlet::control {

// Of a flight, whatever the mode that flies it.
enum class Phase : std::uint8_t {
  kGround = 0,
  kSpoolUp = 1,  // on the ground, thrust rises
  kPath = 2,     // along the reference path
  kSink = 3,     // at the end of a landing, until the ground is felt
};

// Of a mission that was paused: whether the vehicle is still on its way.
enum class MissionPause : std::uint8_t {
  kNone = 0,
  kAway = 1,       // it was sent elsewhere
  kReturning = 2,  // to where it was left
};

// A way that was left, and the time of it, to be gone on with.
struct PausedPath {
  PolynomialSegment segment;
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::int64_t at_ns = 0;
};

// What a stream of attitudes or body rates asks for, by Setpoint's fields.
struct DirectSetpoint {
  std::array<double, 4> q_ned_from_frd{1.0, 0.0, 0.0, 0.0};  // w, x, y, z
  std::array<double, 3> body_rates_frd{};                    // rad/s
  double specific_thrust = 0.0;                                       // m/s^2
};

// Of guidance, from one step to the next. Times are stamps of the vehicle's clock, ns.
struct GuidanceState {
  Phase phase = Phase::kGround;
  std::int64_t phase_since_ns = 0;
  bool airborne = false;

  ReferencePath path;
  double climb_to_z_ned = 0.0;  // m, of the take-off under way
  double climb_speed = 0.5;     // m/s
  double ground_z_ned = 0.0;    // m, where it stood when it was armed

  MissionProgress mission;       // the item index says where in the mission
  std::int64_t item_end_ns = 0;  // of its path and hold, by the path's time; 0: it has not arrived
  MissionPause pause = MissionPause::kNone;  // of a mission that is paused, or returns from that
  PausedPath paused_path;                    // unless kNone
  std::uint64_t trajectory_id = 0;           // of the one being flown
  std::uint32_t next_segment = 0;            // of that trajectory, after the one being flown

  std::int64_t setpoint_ns = 0;  // when the last one was taken
  SetpointKind setpoint_kind = SetpointKind::kPosition;
  DirectSetpoint direct;  // of the kinds that go past the position loop

  bool flying() const { return phase != Phase::kGround; }
  bool mission_paused() const { return mission.state == MissionState::kPaused; }
};

}  // namespace swiftlet::control
