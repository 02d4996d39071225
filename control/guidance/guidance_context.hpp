// The inputs of the manoeuvres in one step, and the state that they change.
#pragma once

#include <cstdint>
#include <limits>

#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/control/guidance/guidance_state.hpp"
#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

// The plans being flown. The sender of the request owns them.
struct FlownPlan {
  const Mission* mission = nullptr;        // the uploaded one, flown or not
  Limits mission_limits;                   // limits of the settings, tightened by the mission's
  const Trajectory* trajectory = nullptr;  // being flown; null in other modes
};

// Stamp of a lift-off that is awaited and has not come.
constexpr std::int64_t kNoLiftOffYet = std::numeric_limits<std::int64_t>::max();

struct GuidanceContext {
  const Limits& limits;  // of the settings, or of the mission while it runs or is paused
  const FailsafeSettings& failsafe;
  const Estimate& estimate;
  const FlownPlan& plan;
  Mode mode;  // selects the manoeuvre
  std::int64_t now_ns;
  GuidanceState& state;
  std::int64_t lift_off_ns = 0;  // of the present take-off; 0: not observed; or kNoLiftOffYet
  double command_delay_s =
      0.0;  // from a sample to the vehicle that obeys the command that answers it; 0: not known
  bool rotors_running = true;  // false: the vehicle has not yet obeyed the command to start them
  bool hover_test = false;
};

inline double elapsed_s(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

}  // namespace swiftlet::control
