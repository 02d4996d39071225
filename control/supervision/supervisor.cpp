#include "swiftlet/control/supervision/supervisor.hpp"

#include <algorithm>

#include "swiftlet/control/guidance/manoeuvres.hpp"
#include "swiftlet/control/guidance/setpoint_stream.hpp"
#include "swiftlet/control/guidance/spool_up.hpp"
#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/supervision/conditions.hpp"
#include "swiftlet/control/supervision/request_progress.hpp"

namespace swiftlet::control {
namespace {

constexpr std::int64_t kProgressPeriod_ns = 20'000'000;  // of requests: that of the telemetry that reports it

}  // namespace

Supervisor::Supervisor(const SupervisionSettings& settings)
    : settings_(settings), tip_over_cosine_(tip_over_cosine(settings.failsafe)) {}

// A mission that runs or is paused has its own limits.
const Limits& Supervisor::limits() const {
  return plan_.mission != nullptr && is_under_way(state_.guidance.mission.state) ? plan_.mission_limits
                                                                                 : settings_.limits;
}

ControlSetpoint Supervisor::step(const SupervisorInputs& inputs, ClientInputs& clients) {
  state_.now_ns = inputs.stamp_ns;
  if (!rotors_off(state_.mode)) advance(context(inputs).guidance());
  answer(clients, inputs);
  if (rotors_off(state_.mode)) {
    forget_silent_ground_links(state_, settings_.failsafe);
    return setpoint(inputs);
  }
  SupervisorContext now = context(inputs);
  const EventSet conditions = observe(now, tip_over_cosine_);
  const Transition* const row = find(now, conditions);
  const bool link_answered =
      row == nullptr ? state_.mode != Mode::kDescent : row->event == Event::kGroundLinkLost;
  if (row != nullptr) take(*row, now);
  // A lost link triggers its row once, but only if no more urgent row was taken.
  if (link_answered && conditions.has(Event::kGroundLinkLost))
    forget_silent_ground_links(state_, settings_.failsafe);
  ControlSetpoint wanted = setpoint(inputs);
  const bool progress_due =
      state_.now_ns < progress_ns_ || state_.now_ns >= progress_ns_ + kProgressPeriod_ns;
  if (progress_due) progress_ns_ = state_.now_ns;
  follow_requests(now, wanted.reference, progress_due);
  return wanted;
}

ControlSetpoint Supervisor::step(const SupervisorInputs& inputs) {
  ClientInputs none;
  return step(inputs, none);
}

void Supervisor::take(const Transition& row, SupervisorContext& context) {
  if (!row.to.stays) enter(row.to.mode, row.reason);
  row.action.run(context);
  end_requests(context, row);
}

// The state of the mission after a change of mode.
MissionState Supervisor::mission_state_in(Mode mode, Reason reason) const {
  const MissionState before = state_.guidance.mission.state;
  if (!is_under_way(before)) return before;
  if (mode == Mode::kMission) return MissionState::kRunning;
  if (reason == Reason::kMissionPaused) return MissionState::kPaused;
  if (before == MissionState::kPaused && mode == Mode::kHolding && reason != Reason::kPlanUnknown)
    return before;
  const bool completed =
      before == MissionState::kRunning && (reason == Reason::kMissionCompleted || reason == Reason::kLanded);
  return completed ? MissionState::kCompleted : MissionState::kAborted;
}

void Supervisor::enter(Mode mode, Reason reason) {
  state_.guidance.mission.state = mission_state_in(mode, reason);
  state_.mode = mode;
  state_.reason = reason;
  state_.mode_since_ns = state_.now_ns;
  state_.contact_since_ns = 0;
  if (rotors_off(mode) || mode == Mode::kArmed) {
    state_.guidance.phase = Phase::kGround;
    state_.guidance.airborne = false;
    state_.low_battery_since_ns = 0;
    state_.critical_battery_since_ns = 0;
  }
  if (mode != Mode::kTrajectory) plan_.trajectory = nullptr;
}

ControlSetpoint Supervisor::setpoint(const SupervisorInputs& inputs) {
  const GuidanceContext guidance = context(inputs).guidance();
  ControlSetpoint setpoint;
  setpoint.reference = reference(guidance);
  const bool lifted_off = inputs.lift_off_ns > 0 && inputs.lift_off_ns != kNoLiftOffYet;
  if (rotors_off(state_.mode)) {
    setpoint.control_mode = ControlMode::kOff;
  } else if (state_.mode == Mode::kArmed) {
    setpoint.control_mode = ControlMode::kIdle;
  } else if (state_.mode == Mode::kDescent) {
    setpoint.control_mode = ControlMode::kLevelDescent;
    setpoint.descent_speed = blind_descent_speed(guidance);
  } else if (state_.guidance.phase == Phase::kSpoolUp && state_.now_ns < state_.guidance.phase_since_ns) {
    setpoint.control_mode = ControlMode::kIdle;  // until the mission's start time
  } else if (state_.guidance.phase == Phase::kSpoolUp && !lifted_off) {
    setpoint.control_mode = ControlMode::kSpoolUp;
    setpoint.lift_fraction = spool_up_lift(guidance);
  } else if (state_.mode == Mode::kSetpoint && goes_past_position(state_.guidance.setpoint_kind)) {
    const DirectSetpoint& direct = state_.guidance.direct;
    const auto& q = direct.q_ned_from_frd;
    const auto& rates = direct.body_rates_frd;
    setpoint.control_mode = state_.guidance.setpoint_kind == SetpointKind::kAttitude
                                ? ControlMode::kAttitude
                                : ControlMode::kBodyRates;
    setpoint.q_ned_from_frd = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    setpoint.body_rates_frd = Eigen::Vector3d(rates[0], rates[1], rates[2]);
    setpoint.specific_thrust = direct.specific_thrust;
    setpoint.integrate = state_.guidance.airborne;
  } else {
    setpoint.control_mode = ControlMode::kFly;
    setpoint.integrate = (state_.guidance.airborne || lifted_off) && state_.guidance.phase != Phase::kSink;
  }
  return setpoint;
}

Outcome Supervisor::answer(Event request, SupervisorContext& context) {
  const Transition* const row = find(context, request);
  if (row == nullptr) return refusal(request, context);
  const Outcome outcome = row->provided.evaluate(context);
  if (outcome.accepted) take(*row, context);
  return outcome;
}

void Supervisor::answer(ClientInputs& clients, const SupervisorInputs& inputs) {
  if (clients.setpoint != nullptr) clients.setpoint_outcome = setpoint(*clients.setpoint, inputs);
  for (std::size_t i = 0; i < clients.request_count; ++i)
    *clients.requests[i].outcome = request(*clients.requests[i].request, inputs);
}

Outcome Supervisor::request(const Request& request, const SupervisorInputs& inputs) {
  Event event = Event::kHold;
  if (!event_of(request.kind, event)) return refuse("unknown request %d", static_cast<int>(request.kind));
  SupervisorContext now = context(inputs);
  now.request = &request;
  const Outcome outcome = answer(event, now);
  if (outcome.accepted) note_accepted(now);
  return outcome;
}

Outcome Supervisor::setpoint(const Setpoint& setpoint, const SupervisorInputs& inputs) {
  SupervisorContext now = context(inputs);
  now.setpoint = &setpoint;
  now.setpoint_period_s = stream_period_s(now.guidance());
  return answer(Event::kSetpoint, now);
}

bool Supervisor::ground_heartbeat(const GroundHeartbeat& heartbeat) {
  GroundLink* slot = nullptr;
  for (GroundLink& link : state_.ground_links) {
    if (link.client == heartbeat.client || (link.client == 0 && slot == nullptr)) slot = &link;
    if (link.client == heartbeat.client) break;
  }
  if (slot == nullptr) return !heartbeat.depends;
  *slot = heartbeat.depends ? GroundLink{heartbeat.client, state_.now_ns} : GroundLink();
  return true;
}

int Supervisor::ground_links() const {
  return static_cast<int>(std::count_if(state_.ground_links.begin(), state_.ground_links.end(),
                                        [](const GroundLink& link) { return link.client != 0; }));
}

void Supervisor::adopt(const SupervisorState& state, const Mission* mission, const Trajectory* trajectory) {
  state_ = state;
  plan_ = FlownPlan();
  adopt_mission(mission);
  bool known = plan_.mission != nullptr || !is_under_way(state_.guidance.mission.state);
  if (state_.mode == Mode::kTrajectory) {
    known = trajectory != nullptr && trajectory->id == state_.guidance.trajectory_id &&
            state_.guidance.next_segment <= trajectory->segments.size();
    if (known) plan_.trajectory = trajectory;
  }
  if (known) return;
  Estimate unused_estimate;  // unused: the vehicle brakes along its reference
  SupervisorInputs inputs;
  inputs.stamp_ns = state_.now_ns;
  inputs.estimate = &unused_estimate;
  SupervisorContext now = context(inputs);
  answer(Event::kPlanUnknown, now);
}

// Drops a mission that has not started and is not known here.
void Supervisor::adopt_mission(const Mission* mission) {
  MissionProgress& progress = state_.guidance.mission;
  if (progress.state == MissionState::kNone) return;
  const bool known = mission != nullptr && mission->id == progress.id &&
                     mission->items.size() == static_cast<std::size_t>(progress.item_count);
  if (known) {
    plan_.mission = mission;
    plan_.mission_limits = tightened(settings_.limits, mission->bounds);
  } else if (progress.state == MissionState::kUploaded) {
    progress = {};
  }
}

Outcome Supervisor::engage_in_flight(const SupervisorInputs& inputs) {
  state_.now_ns = inputs.stamp_ns;
  SupervisorContext now = context(inputs);
  return answer(Event::kEngagedInFlight, now);
}

}  // namespace swiftlet::control
