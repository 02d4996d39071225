// Which mode the vehicle is in, what it is asked to do there, and when it must leave it: the table of
// transitions.hpp, run.
#pragma once

#include <cstdint>

#include "swiftlet/control/supervision/state.hpp"
#include "swiftlet/control/supervision/supervisor_context.hpp"
#include "swiftlet/control/supervision/supervisor_inputs.hpp"
#include "swiftlet/control/supervision/transitions.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::control {

class Supervisor {
 public:
  explicit Supervisor(const SupervisionSettings& settings);

  ControlSetpoint step(const SupervisorInputs& inputs);
  Outcome request(const Request& request, const SupervisorInputs& inputs);
  // Refused setpoints (outside the fence, too fast, not flying) change nothing.
  Outcome setpoint(const Setpoint& setpoint, const SupervisorInputs& inputs);
  // False if the flight depends on kMaxGroundLinks others already.
  bool ground_heartbeat(const GroundHeartbeat& sign);

  Mode mode() const { return state_.mode; }
  Reason reason() const { return state_.reason; }
  const MissionProgress& mission() const { return state_.guidance.mission; }
  bool airborne() const { return state_.guidance.airborne; }
  int ground_links() const;  // ground tools that the flight depends on
  const RequestStatuses& requests() const { return state_.requests; }

  const SupervisorState& state() const { return state_; }
  // Goes on from the state of another controller with the same settings. mission: the one that is there,
  // flown or not; trajectory: the one that is being flown; null where it is not known here, upon which a
  // vehicle that flies it comes to rest and holds. Owned by the caller and kept until the controller has
  // left it.
  void adopt(const SupervisorState& state, const Mission* mission, const Trajectory* trajectory);
  // The vehicle flies, and nobody knows what for: it comes to rest and holds. The ground is taken to be at z
  // = 0. Refused without a pose, or if this supervisor flies it already.
  Outcome engage_in_flight(const SupervisorInputs& inputs);

 private:
  SupervisorContext context(const SupervisorInputs& inputs) {
    return {settings_, limits(), inputs, state_, plan_};
  }
  const Limits& limits() const;
  void take(const Transition& row, SupervisorContext& context);
  void enter(Mode mode, Reason reason);
  MissionState mission_state_in(Mode mode, Reason reason) const;
  void adopt_mission(const Mission* mission);
  Outcome answer(Event request, SupervisorContext& context);
  ControlSetpoint setpoint(const SupervisorInputs& inputs);

  SupervisionSettings settings_;
  double tip_over_cosine_;
  SupervisorState state_;
  FlownPlan plan_;
};

}  // namespace swiftlet::control
