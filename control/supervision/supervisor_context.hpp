// The inputs of guards, preconditions and actions, and the state that actions change.
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
  const Limits& limits;  // of the settings, or of the mission while it runs or is paused
  const SupervisorInputs& inputs;
  SupervisorState& state;
  FlownPlan& plan;
  const Request* request = nullptr;  // the request being answered
  const Setpoint* setpoint = nullptr;
  double setpoint_period_s = 0.0;                               // estimated time to the next one
  mutable std::optional<PolynomialSegment> setpoint_path = {};  // blend into the setpoint, once computed

  const Estimate& estimate() const { return *inputs.estimate; }
  bool flying() const { return state.guidance.flying(); }
  bool paused() const { return state.guidance.mission_paused(); }
  GuidanceContext guidance() const {
    return {limits,
            settings.failsafe,
            estimate(),
            plan,
            state.mode,
            state.now_ns,
            state.guidance,
            inputs.lift_off_ns,
            inputs.command_delay_s,
            inputs.rotors_running && inputs.not_obeyed_s == 0.0,
            in_hover_test(state)};
  }
};

// Where a hover test climbs to.
inline Eigen::Vector3d hover_test_top_ned(const SupervisorContext& context) {
  constexpr double kHeight_m = 0.15;
  Eigen::Vector3d top_ned = context.estimate().position_ned;
  top_ned.z() = context.state.guidance.ground_z_ned - kHeight_m;
  return top_ned;
}

}  // namespace swiftlet::control
