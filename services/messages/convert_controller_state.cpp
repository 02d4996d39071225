#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/messages/convert_gains.hpp"
#include "swiftlet/services/messages/wire.hpp"

namespace swiftlet::messages {
namespace {

using namespace wire;

constexpr std::uint64_t kMaxFailoverPriority = 1000;
constexpr std::size_t kReplicatedStateBytes = 1096;
constexpr std::size_t kReplicatedGainsBytes = 384;

// A path in half of the bytes: 100 m away, it is off by 0.5 mm at most.
using Floats = std::array<float, control::kPolynomialCoefficients>;

control::Polynomial doubles(const Floats& in) {
  control::Polynomial out{};
  std::copy(in.begin(), in.end(), out.begin());
  return out;
}
Floats floats(const control::Polynomial& in) {
  Floats out{};
  std::transform(in.begin(), in.end(), out.begin(), [](double value) { return static_cast<float>(value); });
  return out;
}

// What canceled a request, as it is told. An end by something that is no request of a client is told as none.
control::Event event_of_end(std::uint8_t kind) {
  using namespace msg::RequestStatus_Constants;
  if (kind == KIND_SETPOINT) return control::Event::kSetpoint;
  control::Event event = control::Event::kPlanUnknown;
  control::event_of(static_cast<control::RequestKind>(kind), event);
  return event;
}

// The enumerators go over the wire by these numbers.
static_assert(static_cast<std::uint8_t>(control::Reason::kStarted) ==
              msg::ControlStatus_Constants::REASON_STARTED);
static_assert(static_cast<std::uint8_t>(control::Reason::kRequested) ==
              msg::ControlStatus_Constants::REASON_REQUESTED);
static_assert(static_cast<std::uint8_t>(control::Reason::kTakeOffCompleted) ==
              msg::ControlStatus_Constants::REASON_TAKE_OFF_COMPLETED);
static_assert(static_cast<std::uint8_t>(control::Reason::kMissionCompleted) ==
              msg::ControlStatus_Constants::REASON_MISSION_COMPLETED);
static_assert(static_cast<std::uint8_t>(control::Reason::kTrajectoryCompleted) ==
              msg::ControlStatus_Constants::REASON_TRAJECTORY_COMPLETED);
static_assert(static_cast<std::uint8_t>(control::Reason::kLanded) ==
              msg::ControlStatus_Constants::REASON_LANDED);
static_assert(static_cast<std::uint8_t>(control::Reason::kLandedWithoutPosition) ==
              msg::ControlStatus_Constants::REASON_LANDED_WITHOUT_POSITION);
static_assert(static_cast<std::uint8_t>(control::Reason::kSetpointsCame) ==
              msg::ControlStatus_Constants::REASON_SETPOINTS_CAME);
static_assert(static_cast<std::uint8_t>(control::Reason::kSetpointsStopped) ==
              msg::ControlStatus_Constants::REASON_SETPOINTS_STOPPED);
static_assert(static_cast<std::uint8_t>(control::Reason::kBatteryLow) ==
              msg::ControlStatus_Constants::REASON_BATTERY_LOW);
static_assert(static_cast<std::uint8_t>(control::Reason::kBatteryCritical) ==
              msg::ControlStatus_Constants::REASON_BATTERY_CRITICAL);
static_assert(static_cast<std::uint8_t>(control::Reason::kBatterySilent) ==
              msg::ControlStatus_Constants::REASON_BATTERY_SILENT);
static_assert(static_cast<std::uint8_t>(control::Reason::kOutsideFence) ==
              msg::ControlStatus_Constants::REASON_OUTSIDE_FENCE);
static_assert(static_cast<std::uint8_t>(control::Reason::kNoPose) ==
              msg::ControlStatus_Constants::REASON_NO_POSE);
static_assert(static_cast<std::uint8_t>(control::Reason::kPoseIsBack) ==
              msg::ControlStatus_Constants::REASON_POSE_IS_BACK);
static_assert(static_cast<std::uint8_t>(control::Reason::kDescentTimedOut) ==
              msg::ControlStatus_Constants::REASON_DESCENT_TIMED_OUT);
static_assert(static_cast<std::uint8_t>(control::Reason::kTippedOver) ==
              msg::ControlStatus_Constants::REASON_TIPPED_OVER);
static_assert(static_cast<std::uint8_t>(control::Reason::kImuUnusable) ==
              msg::ControlStatus_Constants::REASON_IMU_UNUSABLE);
static_assert(static_cast<std::uint8_t>(control::Reason::kImuGap) ==
              msg::ControlStatus_Constants::REASON_IMU_GAP);
static_assert(static_cast<std::uint8_t>(control::Reason::kGroundLinkLost) ==
              msg::ControlStatus_Constants::REASON_GROUND_LINK_LOST);
static_assert(static_cast<std::uint8_t>(control::Reason::kImpact) ==
              msg::ControlStatus_Constants::REASON_IMPACT);
static_assert(static_cast<std::uint8_t>(control::Reason::kTakeoffInconsistent) ==
              msg::ControlStatus_Constants::REASON_TAKEOFF_INCONSISTENT);
static_assert(static_cast<std::uint8_t>(control::Reason::kPoseJumped) ==
              msg::ControlStatus_Constants::REASON_POSE_JUMPED);
static_assert(static_cast<std::uint8_t>(control::Reason::kPlanUnknown) ==
              msg::ControlStatus_Constants::REASON_PLAN_UNKNOWN);
static_assert(static_cast<std::uint8_t>(control::Reason::kEngagedInFlight) ==
              msg::ControlStatus_Constants::REASON_ENGAGED_IN_FLIGHT);
static_assert(static_cast<std::uint8_t>(control::Reason::kSetpointsViolatedFence) ==
              msg::ControlStatus_Constants::REASON_SETPOINTS_VIOLATED_FENCE);
static_assert(static_cast<std::uint8_t>(control::Reason::kMissionPaused) ==
              msg::ControlStatus_Constants::REASON_MISSION_PAUSED);
static_assert(static_cast<std::uint8_t>(control::Reason::kVehicleFault) ==
              msg::ControlStatus_Constants::REASON_VEHICLE_FAULT);
static_assert(static_cast<std::uint8_t>(control::Reason::kRotorsNotRunning) ==
              msg::ControlStatus_Constants::REASON_ROTORS_NOT_RUNNING);
static_assert(static_cast<std::uint8_t>(control::Reason::kVehicleRestarted) ==
              msg::ControlStatus_Constants::REASON_VEHICLE_RESTARTED);
static_assert(static_cast<std::uint8_t>(control::Reason::kNotObeyed) ==
              msg::ControlStatus_Constants::REASON_NOT_OBEYED);
static_assert(static_cast<std::uint8_t>(control::Reason::kNoLiftOff) ==
              msg::ControlStatus_Constants::REASON_NO_LIFT_OFF);
static_assert(static_cast<std::uint8_t>(control::Reason::kHoverTest) ==
              msg::ControlStatus_Constants::REASON_HOVER_TEST);
static_assert(static_cast<std::uint8_t>(control::Reason::kHoverTestPassed) ==
              msg::ControlStatus_Constants::REASON_HOVER_TEST_PASSED);
static_assert(static_cast<std::uint8_t>(control::Reason::kHoverTestFailed) ==
              msg::ControlStatus_Constants::REASON_HOVER_TEST_FAILED);
static_assert(control::kReasonCount == 35);
static_assert(static_cast<std::uint8_t>(control::Phase::kGround) ==
              msg::ControllerState_Constants::PHASE_ON_GROUND);
static_assert(static_cast<std::uint8_t>(control::Phase::kSpoolUp) ==
              msg::ControllerState_Constants::PHASE_SPOOL_UP);
static_assert(static_cast<std::uint8_t>(control::Phase::kPath) ==
              msg::ControllerState_Constants::PHASE_ON_PATH);
static_assert(static_cast<std::uint8_t>(control::Phase::kSink) ==
              msg::ControllerState_Constants::PHASE_FINAL_DESCENT);
static_assert(static_cast<std::uint8_t>(control::MissionPause::kNone) ==
              msg::ControllerState_Constants::PAUSE_NONE);
static_assert(static_cast<std::uint8_t>(control::MissionPause::kAway) ==
              msg::ControllerState_Constants::PAUSE_AWAY);
static_assert(static_cast<std::uint8_t>(control::MissionPause::kReturning) ==
              msg::ControllerState_Constants::PAUSE_RETURNING);

Check check_controller_state(const msg::ControllerState& in) {
  using namespace msg;
  Check check;
  check.time(in.stamp_ns())
      .at_most("failover_priority", in.failover_priority(), kMaxFailoverPriority)
      .at_most("role", in.role(), ControllerState_Constants::ACTIVE)
      .at_most("mode", in.mode(), ControlStatus_Constants::MODE_STOPPED)
      .at_most("reason", in.reason(), control::kReasonCount - 1)
      .at_most("phase", in.phase(), ControllerState_Constants::PHASE_FINAL_DESCENT)
      .at_least("path_duration_s", in.path_duration_s(), 0.0)
      .finite("path_x", in.path_x())
      .finite("path_y", in.path_y())
      .finite("path_z", in.path_z())
      .finite("path_yaw", in.path_yaw())
      .at_least("clock_change_s", in.clock_change_s(), 0.0)
      .finite("clock_rate", in.clock_rate())
      .finite("climb_to_z_ned", in.climb_to_z_ned())
      .finite("climb_speed", in.climb_speed())
      .finite("ground_z_ned", in.ground_z_ned())
      .at_most("mission_state", in.mission_state(), MissionStatus_Constants::PAUSED)
      .at_most("item_count", in.item_count(), control::kMaxMissionItems)
      .at_most("item_index", in.item_index(), in.item_count())
      .at_most("pause", in.pause(), ControllerState_Constants::PAUSE_RETURNING)
      .at_least("paused_path_duration_s", in.paused_path_duration_s(), 0.0)
      .finite("paused_path_x", in.paused_path_x())
      .finite("paused_path_y", in.paused_path_y())
      .finite("paused_path_z", in.paused_path_z())
      .finite("paused_path_yaw", in.paused_path_yaw())
      .at_most("next_segment", in.next_segment(), control::kMaxTrajectorySegments)
      .at_most("setpoint_kind", in.setpoint_kind(), Setpoint_Constants::BODY_RATES)
      .finite("setpoint_attitude", in.setpoint_attitude())
      .finite("setpoint_body_rates", in.setpoint_body_rates())
      .finite("setpoint_specific_thrust", in.setpoint_specific_thrust())
      .finite("position_integral_ned", in.position_integral_ned())
      .at_least("lift_ratio", in.lift_ratio(), 0.0)
      .at_least("gains_duration_s", in.gains_duration_s(), 0.0)
      .at_most("rotor_state", in.rotor_state(), ActuatorCommand_Constants::ROTORS_RUNNING)
      .per_rotor("throttle", in.rotor_count(), in.throttle(), 0.0, 1.0);
  for (std::size_t i = 0; i < control::kRememberedRequests; ++i) {
    check.at_most("request_states", in.request_states()[i], RequestStatus_Constants::ABORTED)
        .at_most("request_reasons", in.request_reasons()[i], control::kReasonCount - 1)
        .within("request_progress", in.request_progress()[i], 0.0, 1.0);
  }
  check_gains("gains_from", in.gains_from(), check);
  check_gains("gains_to", in.gains_to(), check);
  return check;
}

void read_guidance(const msg::ControllerState& in, control::GuidanceState& state) {
  state.phase = static_cast<control::Phase>(in.phase());
  state.airborne = in.airborne();
  state.phase_since_ns = in.phase_since_ns();
  state.path.moving = in.path_moving();
  state.path.segment = {in.path_duration_s(), doubles(in.path_x()), doubles(in.path_y()),
                        doubles(in.path_z()), doubles(in.path_yaw())};
  state.path.start_ns = in.path_start_ns();
  state.path.end_ns = in.path_end_ns();
  state.path.clock = {in.clock_runs(), in.clock_change_ns(), in.clock_from_ns(), in.clock_change_s(),
                      doubles(in.clock_rate())};
  state.climb_to_z_ned = in.climb_to_z_ned();
  state.climb_speed = in.climb_speed();
  state.ground_z_ned = in.ground_z_ned();
  state.mission = {in.mission_id(), static_cast<control::MissionState>(in.mission_state()),
                   static_cast<int>(in.item_index()), static_cast<int>(in.item_count())};
  state.item_end_ns = in.item_end_ns();
  state.pause = static_cast<control::MissionPause>(in.pause());
  state.paused_path = {{in.paused_path_duration_s(), doubles(in.paused_path_x()), doubles(in.paused_path_y()),
                        doubles(in.paused_path_z()), doubles(in.paused_path_yaw())},
                       in.paused_path_start_ns(),
                       in.paused_path_end_ns(),
                       in.paused_path_at_ns()};
  state.trajectory_id = in.trajectory_id();
  state.next_segment = in.next_segment();
  state.setpoint_ns = in.setpoint_ns();
  state.setpoint_kind = static_cast<control::SetpointKind>(in.setpoint_kind());
  state.direct = {in.setpoint_attitude(), in.setpoint_body_rates(), in.setpoint_specific_thrust()};
}

void read_requests(const msg::ControllerState& in, control::SupervisorState& state) {
  for (std::size_t i = 0; i < state.requests.size(); ++i) {
    state.requests[i] = {{in.request_clients()[i], in.request_ids()[i]},
                         static_cast<control::RequestKind>(in.request_kinds()[i]),
                         static_cast<control::RequestState>(in.request_states()[i]),
                         event_of_end(in.request_ended_by()[i]),
                         static_cast<control::Reason>(in.request_reasons()[i]),
                         in.request_progress()[i]};
  }
}

void read_supervisor(const msg::ControllerState& in, control::SupervisorState& state) {
  state.mode = static_cast<control::Mode>(in.mode());
  state.reason = static_cast<control::Reason>(in.reason());
  state.now_ns = in.stamp_ns();
  state.mode_since_ns = in.mode_since_ns();
  read_guidance(in, state.guidance);
  state.contact_since_ns = in.contact_since_ns();
  state.low_battery_since_ns = in.low_battery_since_ns();
  state.critical_battery_since_ns = in.critical_battery_since_ns();
  state.land_on_return = in.land_on_return();
  for (std::size_t i = 0; i < state.ground_links.size(); ++i)
    state.ground_links[i] = {in.ground_link_clients()[i], in.ground_link_heard_ns()[i]};
  read_requests(in, state);
}

void read_flight(const msg::ControllerState& in, control::FlightState& out) {
  read_supervisor(in, out.supervisor);
  out.position_integral = vector(in.position_integral_ned());
  out.lift_ratio = in.lift_ratio();
  out.gains.from = from_message(in.gains_from());
  out.gains.to = from_message(in.gains_to());
  std::copy_n(in.settings_name().begin(), control::kMaxSettingsName, out.gains.name.begin());
  out.gains.start_ns = in.gains_start_ns();
  out.gains.duration_s = in.gains_duration_s();
  out.rotor_state = static_cast<plant::RotorState>(in.rotor_state());
}

void write(const control::GuidanceState& state, msg::ControllerState& out) {
  out.phase(static_cast<std::uint8_t>(state.phase));
  out.airborne(state.airborne);
  out.phase_since_ns(state.phase_since_ns);
  out.path_moving(state.path.moving);
  out.path_start_ns(state.path.start_ns);
  out.path_end_ns(state.path.end_ns);
  out.path_duration_s(state.path.segment.duration_s);
  out.path_x(floats(state.path.segment.x));
  out.path_y(floats(state.path.segment.y));
  out.path_z(floats(state.path.segment.z));
  out.path_yaw(floats(state.path.segment.yaw));
  out.clock_runs(state.path.clock.runs);
  out.clock_change_ns(state.path.clock.change_ns);
  out.clock_from_ns(state.path.clock.from_ns);
  out.clock_change_s(state.path.clock.change_s);
  out.clock_rate(floats(state.path.clock.rate));
  out.climb_to_z_ned(state.climb_to_z_ned);
  out.climb_speed(state.climb_speed);
  out.ground_z_ned(state.ground_z_ned);
  out.mission_id(state.mission.id);
  out.mission_state(static_cast<std::uint8_t>(state.mission.state));
  out.item_index(static_cast<std::uint32_t>(state.mission.item_index));
  out.item_count(static_cast<std::uint32_t>(state.mission.item_count));
  out.item_end_ns(state.item_end_ns);
  out.pause(static_cast<std::uint8_t>(state.pause));
  out.paused_path_start_ns(state.paused_path.start_ns);
  out.paused_path_end_ns(state.paused_path.end_ns);
  out.paused_path_at_ns(state.paused_path.at_ns);
  out.paused_path_duration_s(state.paused_path.segment.duration_s);
  out.paused_path_x(floats(state.paused_path.segment.x));
  out.paused_path_y(floats(state.paused_path.segment.y));
  out.paused_path_z(floats(state.paused_path.segment.z));
  out.paused_path_yaw(floats(state.paused_path.segment.yaw));
  out.trajectory_id(state.trajectory_id);
  out.next_segment(state.next_segment);
  out.setpoint_ns(state.setpoint_ns);
  out.setpoint_kind(static_cast<std::uint8_t>(state.setpoint_kind));
  out.setpoint_attitude(state.direct.q_ned_from_frd);
  out.setpoint_body_rates(state.direct.body_rates_frd);
  out.setpoint_specific_thrust(state.direct.specific_thrust);
}

void write(const control::RequestStatuses& requests, msg::ControllerState& out) {
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const control::RequestStatus& request = requests[i];
    out.request_clients()[i] = request.key.client;
    out.request_ids()[i] = request.key.id;
    out.request_kinds()[i] = static_cast<std::uint8_t>(request.kind);
    out.request_states()[i] = static_cast<std::uint8_t>(request.state);
    out.request_ended_by()[i] = kind_of_end(request);
    out.request_reasons()[i] = static_cast<std::uint8_t>(request.reason);
    out.request_progress()[i] = static_cast<float>(request.progress);
  }
}

void write(const control::SupervisorState& state, msg::ControllerState& out) {
  out.mode(static_cast<std::uint8_t>(state.mode));
  out.reason(static_cast<std::uint8_t>(state.reason));
  out.mode_since_ns(state.mode_since_ns);
  write(state.guidance, out);
  out.contact_since_ns(state.contact_since_ns);
  out.low_battery_since_ns(state.low_battery_since_ns);
  out.critical_battery_since_ns(state.critical_battery_since_ns);
  out.land_on_return(state.land_on_return);
  for (std::size_t i = 0; i < state.ground_links.size(); ++i) {
    out.ground_link_clients()[i] = state.ground_links[i].client;
    out.ground_link_heard_ns()[i] = state.ground_links[i].heard_ns;
  }
  write(state.requests, out);
}

}  // namespace

std::uint8_t kind_of_end(const control::RequestStatus& request) {
  using namespace msg::RequestStatus_Constants;
  if (request.state != control::RequestState::kCanceled) return KIND_NONE;
  if (request.ended_by == control::Event::kSetpoint) return KIND_SETPOINT;
  const auto kind = control::kind_of(request.ended_by);
  return kind ? static_cast<std::uint8_t>(*kind) : KIND_NONE;
}

Fault from_message(const msg::ControllerState& in, ControllerReport& out) {
  const Check check = check_controller_state(in);
  if (!check.ok()) return check.fault();
  out.stamp_ns = in.stamp_ns();
  out.sequence = in.sequence_number();
  out.controller = in.controller();
  out.failover_priority = static_cast<int>(in.failover_priority());
  out.term = in.term();
  out.active = in.role() == msg::ControllerState_Constants::ACTIVE;
  out.ready = in.ready();
  read_flight(in, out.flight);
  out.rotor_count = in.rotor_count();
  copy_rotors(out.rotor_count, in.throttle(), out.flight.throttle);
  return {};
}

// A field added to the state must be added to the message: otherwise a standby continues without it.
static_assert(sizeof(control::SupervisorState) == kReplicatedStateBytes,
              "controller_state does not carry all of SupervisorState");
static_assert(sizeof(control::GainChange) == kReplicatedGainsBytes,
              "controller_state does not carry all of GainChange");

msg::ControllerState to_message(const ControllerReport& in) {
  msg::ControllerState out;
  out.stamp_ns(in.stamp_ns);
  out.sequence_number(in.sequence);
  out.controller(in.controller);
  out.failover_priority(static_cast<std::uint32_t>(in.failover_priority));
  out.term(in.term);
  out.role(in.active ? msg::ControllerState_Constants::ACTIVE : msg::ControllerState_Constants::STANDBY);
  out.ready(in.ready);
  write(in.flight.supervisor, out);
  out.position_integral_ned(array(in.flight.position_integral));
  out.lift_ratio(in.flight.lift_ratio);
  out.gains_from(to_message(in.flight.gains.from));
  out.gains_to(to_message(in.flight.gains.to));
  std::copy(in.flight.gains.name.begin(), in.flight.gains.name.end(), out.settings_name().begin());
  out.gains_start_ns(in.flight.gains.start_ns);
  out.gains_duration_s(in.flight.gains.duration_s);
  out.rotor_state(static_cast<std::uint8_t>(in.flight.rotor_state));
  out.rotor_count(static_cast<std::uint8_t>(in.rotor_count));
  out.throttle(in.flight.throttle);
  return out;
}

}  // namespace swiftlet::messages
