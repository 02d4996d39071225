// What the manoeuvres of one step look at, and what they change.
#pragma once

#include <cstdint>

#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/control/guidance/guidance_state.hpp"
#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

// Owned by who asked for it.
struct FlownPlan {
  const Mission* mission = nullptr;        // the one that was uploaded, flown or not
  Limits mission_limits;                   // the settings', as that mission tightens them
  const Trajectory* trajectory = nullptr;  // the one being flown; null in other modes
};

struct GuidanceContext {
  const Limits& limits;  // the settings', or while a mission is under way those of the mission
  const FailsafeSettings& failsafe;
  const Estimate& estimate;
  const FlownPlan& plan;
  Mode mode;  // names the manoeuvre
  std::int64_t now_ns;
  GuidanceState& state;
};

inline double elapsed_s(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

}  // namespace swiftlet::control
