// What the rules of supervision look at, and what their actions change.
#pragma once

#include <optional>

#include "swiftlet/control/guidance/guidance_context.hpp"
#include "swiftlet/control/supervision/state.hpp"
#include "swiftlet/control/supervision/supervisor_inputs.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

struct SupervisionSettings {
  Limits limits;
  ArmingSettings arming;
  FailsafeSettings failsafe;
};

struct SupervisorContext {
  const SupervisionSettings& settings;
  const Limits& limits;  // the settings', or while a mission is under way those of the mission
  const SupervisorInputs& inputs;
  SupervisorState& state;
  FlownPlan& plan;
  const Request* request = nullptr;  // to be answered
  const Setpoint* setpoint = nullptr;
  double setpoint_period_s = 0.0;                           // until the next one, by that since the last
  mutable std::optional<PolynomialSegment> way_taken = {};  // into the setpoint, once it was worked out

  const Estimate& estimate() const { return *inputs.estimate; }
  bool flying() const { return state.guidance.flying(); }
  bool paused() const { return state.guidance.mission_paused(); }
  GuidanceContext guidance() const {
    return {limits, settings.failsafe, estimate(), plan, state.mode, state.now_ns, state.guidance};
  }
};

}  // namespace swiftlet::control
