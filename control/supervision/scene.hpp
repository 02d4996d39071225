// What the rules of supervision look at, and what their actions change.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/control/mission.hpp"
#include "swiftlet/control/request.hpp"
#include "swiftlet/control/settings.hpp"
#include "swiftlet/control/supervision/situation.hpp"
#include "swiftlet/control/supervision/state.hpp"
#include "swiftlet/control/trajectory/polynomial.hpp"

namespace swiftlet::control {

struct SupervisionSettings {
  Limits limits;
  ArmingSettings arming;
  FailsafeSettings failsafe;
};

// Owned by who asked for it.
struct FlownPlan {
  const Mission* mission = nullptr;        // the one that was uploaded, flown or not
  Limits mission_limits;                   // the settings', as that mission tightens them
  const Trajectory* trajectory = nullptr;  // the one being flown; null in other modes
};

struct Scene {
  const SupervisionSettings& settings;
  const Limits& limits;  // the settings', or while a mission is under way those of the mission
  const Situation& situation;
  SupervisorState& state;
  FlownPlan& plan;
  const Request* request = nullptr;  // to be answered
  const Setpoint* setpoint = nullptr;
  double setpoint_period_s = 0.0;                           // until the next one, by that since the last
  mutable std::optional<PolynomialSegment> way_taken = {};  // into the setpoint, once it was worked out

  const Estimate& estimate() const { return *situation.estimate; }
  bool flying() const { return state.phase != Phase::kGround; }
  bool paused() const { return state.mission.state == MissionState::kPaused; }
};

inline double elapsed_s(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

}  // namespace swiftlet::control
