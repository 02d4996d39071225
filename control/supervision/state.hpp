// All that the supervisor remembers from one step to the next, as plain data: another process that is given
// it, with the plan being flown, goes on exactly where this one stopped.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "swiftlet/control/mode.hpp"
#include "swiftlet/control/request.hpp"
#include "swiftlet/control/supervision/request_status.hpp"
#include "swiftlet/control/trajectory/reference_path.hpp"

namespace swiftlet::control {

// Of a flight, whatever the mode that flies it.
enum class Phase : std::uint8_t {
  kGround = 0,
  kSpoolUp = 1,  // on the ground, thrust rises
  kPath = 2,     // along the reference path
  kSink = 3,     // at the end of a landing, until the ground is felt
};

// Of a mission that was paused: whether the vehicle is still on its way.
enum class Detour : std::uint8_t {
  kNone = 0,
  kAway = 1,       // it was sent elsewhere
  kReturning = 2,  // to where it was left
};

// A way that was left, and the time of it, to be gone on with.
struct LeftPath {
  PolynomialSegment segment;
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::int64_t at_ns = 0;
};

// A ground tool that the flight depends on.
struct GroundLink {
  std::uint64_t client = 0;  // 0: none
  std::int64_t heard_ns = 0;
};
constexpr int kMaxGroundLinks = 4;

// What a stream of attitudes or body rates asks for, by Setpoint's fields.
struct DirectSetpoint {
  std::array<double, 4> q_ned_from_frd{1.0, 0.0, 0.0, 0.0};  // w, x, y, z
  std::array<double, 3> body_rates_frd{};                    // rad/s
  double thrust = 0.0;                                       // m/s^2
};

// Times are stamps of the vehicle's clock, ns.
struct SupervisorState {
  Mode mode = Mode::kDisarmed;
  Reason reason = Reason::kStarted;
  Phase phase = Phase::kGround;
  bool airborne = false;
  bool land_on_return = false;  // in descent without position: a landing was under way
  std::int64_t now_ns = 0;      // of the last step
  std::int64_t mode_since_ns = 0;
  std::int64_t phase_since_ns = 0;

  ReferencePath path;
  double climb_to_z_ned = 0.0;  // m, of the take-off under way
  double climb_speed = 0.5;     // m/s
  double ground_z_ned = 0.0;    // m, where it stood when it was armed

  MissionProgress mission;          // the item index says where in the mission
  std::int64_t item_end_ns = 0;     // of its path and hold, by the path's time; 0: it has not arrived
  Detour detour = Detour::kNone;    // of a mission that is paused, or returns from that
  LeftPath left;                    // unless kNone
  std::uint64_t trajectory_id = 0;  // of the one being flown
  std::uint32_t next_segment = 0;   // of that trajectory, after the one being flown

  std::int64_t setpoint_ns = 0;  // when the last one was taken
  SetpointKind setpoint_kind = SetpointKind::kPosition;
  DirectSetpoint direct;                       // of the kinds that go past the position loop
  std::int64_t contact_since_ns = 0;           // 0: the ground is not felt
  std::int64_t low_battery_since_ns = 0;       // 0: the battery is well
  std::int64_t critical_battery_since_ns = 0;  // 0: it is not that low
  std::array<GroundLink, kMaxGroundLinks> ground_links{};
  RequestStatuses requests{};
};
static_assert(std::is_trivially_copyable_v<SupervisorState>);

}  // namespace swiftlet::control
