// The supervisor: runs the table of transitions.hpp. It decides the mode, the setpoint of each step, and the
// reaction to conditions and requests.
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

  // Advances the manoeuvre, answers the clients, then evaluates the conditions: failsafes have the last word.
  ControlSetpoint step(const SupervisorInputs& inputs, ClientInputs& clients);
  ControlSetpoint step(const SupervisorInputs& inputs);
  // While time stands still: answers clients alone, as step() does.
  void answer(ClientInputs& clients, const SupervisorInputs& inputs);
  Outcome request(const Request& request, const SupervisorInputs& inputs);
  // Refused setpoints (outside the fence, too fast, not in flight) change nothing.
  Outcome setpoint(const Setpoint& setpoint, const SupervisorInputs& inputs);
  // Returns false if the link-loss failsafe is on for kMaxGroundLinks other clients already.
  bool ground_heartbeat(const GroundHeartbeat& heartbeat);

  Mode mode() const { return state_.mode; }
  Reason reason() const { return state_.reason; }
  const MissionProgress& mission() const { return state_.guidance.mission; }
  bool airborne() const { return state_.guidance.airborne; }
  int ground_links() const;  // clients with the link-loss failsafe on
  const RequestStatuses& requests() const { return state_.requests; }

  const SupervisorState& state() const { return state_; }
  // Continues from the state of another controller with the same settings. mission: the uploaded one, flown
  // or not. trajectory: the one being flown. Null if it is not known here: a vehicle that flies it then
  // brakes and holds. Both are owned by the caller and kept until the controller has left them.
  void adopt(const SupervisorState& state, const Mission* mission, const Trajectory* trajectory);
  // Takes control of a vehicle already in flight, whose state is not known: it brakes and holds. The ground
  // is assumed at z = 0. Refused without a pose, or if this supervisor is not in disarmed mode.
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
  std::int64_t progress_ns_ = 0;  // when the progress of requests was computed
};

}  // namespace swiftlet::control
