#include "swiftlet/services/control/inner_loop.hpp"

#include <algorithm>

#include "swiftlet/plant/model/telemetry_rate.hpp"

namespace swiftlet::services {
namespace {

constexpr int kRotorSamples = 20;  // for the rotor observer to converge to the measured speeds
constexpr std::int64_t kStandbyReportNs = 100'000'000;
constexpr std::int64_t kOldFlightNs = 2'000'000'000;  // longer than another controller takes to see a restart

}  // namespace

InnerLoop::InnerLoop(const plant::Vehicle& vehicle, const control::ControlSettings& settings)
    : controller_(vehicle, settings) {}

plant::VehicleCommand InnerLoop::step(const plant::ImuSample& sample, std::int64_t now_ns, Role role,
                                      std::uint32_t followed_term) {
  Clients clients;
  begin_step(sample.stamp_ns, now_ns, role, followed_term, clients);
  const plant::VehicleCommand command = controller_.on_imu(sample, clients.inputs);
  end_step(command, clients, sample.stamp_ns, sample.sequence, now_ns);
  return command;
}

plant::VehicleCommand InnerLoop::step(const plant::OdometrySample& sample, std::int64_t now_ns, Role role,
                                      std::uint32_t followed_term) {
  Clients clients;
  begin_step(sample.stamp_ns, now_ns, role, followed_term, clients);
  const plant::VehicleCommand command = controller_.on_odometry(sample, clients.inputs);
  end_step(command, clients, sample.stamp_ns, sample.sequence, now_ns);
  return command;
}

void InnerLoop::begin_step(std::int64_t stamp_ns, std::int64_t now_ns, Role role, std::uint32_t followed_term,
                           Clients& clients) {
  last_arrival_ns_.store(now_ns, std::memory_order_relaxed);
  role_ = role;
  take_samples();
  take_levels();
  control::VehicleFault fault;
  if (vehicle_fault.take(fault)) controller_.set_vehicle_fault(fault);
  if (vehicle_refusal.take(fault)) controller_.set_vehicle_refusal(fault);
  controller_.set_rotors_running(vehicle_rotors_running.load(std::memory_order_relaxed));
  take_heartbeats();
  if (role == Role::kStandby) follow(followed_term);
  if (detecting_airborne()) detect_airborne(stamp_ns);
  take_setpoint(clients);
  take_requests(clients);
}

void InnerLoop::end_step(const plant::VehicleCommand& command, const Clients& clients, std::int64_t stamp_ns,
                         std::uint64_t sequence, std::int64_t now_ns) {
  level_.store(plant::level_of(command), std::memory_order_relaxed);
  return_outcomes(clients, stamp_ns);
  rotors_running_ = plant::header_of(command).rotor_state == plant::RotorState::kRunning;
  stamp_ns_ = stamp_ns;
  if (!controller_.status().has_pose) unposed_ns_ = stamp_ns;
  last_imu_sequence_ = imu_sequence_;
  imu_sequence_ = sequence;
  timing_.arrived(sequence, stamp_ns, now_ns, rotors_running_);
}

void InnerLoop::take_samples() {
  plant::PoseSample new_pose;
  if (pose.take(new_pose)) controller_.on_pose(new_pose);
  plant::BatterySample new_battery;
  if (battery.take(new_battery)) controller_.on_battery(new_battery);
  plant::RotorSpeedSample new_rotor_speeds;
  if (rotor_speeds.take(new_rotor_speeds)) {
    controller_.on_rotor_speeds(new_rotor_speeds);
    ++rotor_samples_;
  }
}

// A choice that comes while the rotors turn may take effect only when they are off.
void InnerLoop::take_levels() {
  if (levels.take(level_choice_) || !rotors_running_)
    controller_.set_levels(level_choice_.accepted, level_choice_.wanted);
}

void InnerLoop::take_setpoint(Clients& clients) {
  if (setpoint.take(clients.setpoint) && role_ == Role::kActive) clients.inputs.setpoint = &clients.setpoint;
}

void InnerLoop::set_obeyed(const plant::ObeyedCommand& obeyed, Role role, std::uint32_t term) {
  has_obeyed_ = has_obeyed_ || (obeyed.reported && obeyed.any);
  const bool of_this = obeyed.any && obeyed.term == term;
  controller_.set_obeyed(obeyed, role == Role::kStandby || !obeyed.reported || of_this);
}

void InnerLoop::restart_vehicle(std::int64_t now_ns) {
  has_obeyed_ = false;
  restarted_ns_ = now_ns;
  detecting_since_ns_ = kNotDetecting;
  controller_.restart_vehicle();
}

// The active controller's report of a flight may still be on its way, and it may be dead.
bool InnerLoop::predates_restart(const FailoverState& state) const {
  if (has_obeyed_ || control::rotors_off(state.flight.supervisor.mode)) return false;
  return last_arrival_ns_.load(std::memory_order_relaxed) - restarted_ns_ < kOldFlightNs;
}

void InnerLoop::follow(std::uint32_t term) {
  FailoverState newest;
  if (!failover_state.take(newest)) return;
  if (newest.term == term && !predates_restart(newest)) {
    controller_.adopt(newest.flight, newest.mission, newest.trajectory);
    const control::SupervisorState& state = newest.flight.supervisor;
    const bool has_mission = state.guidance.mission.state == control::MissionState::kUploaded ||
                             control::is_under_way(state.guidance.mission.state);
    knows_plan_ = (!has_mission || newest.mission != nullptr) &&
                  (state.mode != control::Mode::kTrajectory || newest.trajectory != nullptr);
    detecting_since_ns_ = kNotDetecting;
    adopted_state_.store(newest.number, std::memory_order_release);
  }
}

// Uses the state before this sample; therefore the first call only begins the detection.
void InnerLoop::detect_airborne(std::int64_t stamp_ns) {
  if (detecting_since_ns_ == kDetectFromNow || stamp_ns < detecting_since_ns_) {
    detecting_since_ns_ = stamp_ns;
    rotor_samples_ = 0;
    return;
  }
  const bool over = stamp_ns - detecting_since_ns_ > kAirborneDetectionNs;
  const bool rotors_known = rotor_samples_ >= kRotorSamples || over;
  if (!rotors_known) return;
  const bool stands = !controller_.detects_airborne();
  if (stands || over || controller_.engage_in_flight()) detecting_since_ns_ = kNotDetecting;
}

void InnerLoop::take_heartbeats() {
  ground_heartbeats.consume_all(
      [this](const control::GroundHeartbeat& heartbeat) { controller_.on_ground_heartbeat(heartbeat); });
}

// The active controller receives a standby's requests too and answers them.
void InnerLoop::take_requests(Clients& clients) {
  PendingRequest* pending = nullptr;
  while (requests.pop(pending)) {
    clients.requests.at(clients.request_count++) = pending;
    if (role_ == Role::kStandby) {
      pending->claim(PendingRequest::State::kGivenUp);
    } else if (pending->claim(PendingRequest::State::kTaken)) {
      clients.inputs.add(pending->request, pending->outcome);
    }
  }
}

void InnerLoop::return_outcomes(const Clients& clients, std::int64_t stamp_ns) {
  if (clients.inputs.setpoint != nullptr) count(clients.inputs.setpoint_outcome);
  for (std::size_t i = 0; i < clients.request_count; ++i) {
    PendingRequest* const pending = clients.requests[i];
    pending->stamp_ns = stamp_ns;
    accepted_any_ = accepted_any_ || pending->outcome.accepted;
    evaluated.push(pending);  // always fits: at most kMaxPendingRequests
    evaluated_any_ = true;
  }
}

void InnerLoop::count(const control::Outcome& setpoint_outcome) {
  if (setpoint_outcome.accepted) {
    ++setpoints_.accepted;
    return;
  }
  ++setpoints_.refused;
  setpoints_.refusal = setpoint_outcome;
}

void InnerLoop::answer_requests() {
  Clients clients;
  take_requests(clients);
  controller_.answer(clients.inputs);
  return_outcomes(clients, stamp_ns_);
}

void InnerLoop::report(messages::ControllerReport& report) const {
  report.active = role_ == Role::kActive;
  report.ready =
      (report.active && !detecting_airborne()) ||
      (knows_plan_ && stamp_ns_ - unposed_ns_ >= kReadyAfterNs && level_choice_.accepted.has(level()));
  if (!report.active) return;
  report.flight = controller_.state();
}

bool InnerLoop::finish(std::int64_t now_ns, const LoopDelay::Figures& loop_delay) {
  timing_.answered(now_ns);
  const control::Status& status = controller_.status();
  saturated_ = saturated_ || status.saturated;
  const bool sampled = timing_.period_ns() > 0 &&
                       plant::is_telemetry_sample(imu_sequence_, last_imu_sequence_, timing_.period_ns());
  const bool answers = evaluated_any_;
  const bool changed = status_changed() || role_ != snapshot_role_;
  const bool old = stamp_ns_ < reported_ns_ || stamp_ns_ - reported_ns_ >= kStandbyReportNs;
  report_due_ = (sampled && role_ == Role::kActive) || old || changed || accepted_any_;
  if (report_due_) reported_ns_ = stamp_ns_;
  evaluated_any_ = false;
  accepted_any_ = false;
  if (!sampled && !changed) return answers;

  snapshot_.stamp_ns = stamp_ns_;
  snapshot_.sampled = sampled;
  snapshot_.estimate = controller_.estimate();
  if (sampled) snapshot_.estimate_deviation = controller_.estimate_deviation();
  snapshot_.reference = controller_.reference();
  snapshot_.setpoint = controller_.attitude_setpoint();
  snapshot_.status = status;
  snapshot_.requests = controller_.requests();
  snapshot_.gains = controller_.gains();
  snapshot_.trajectory_id = controller_.state().supervisor.guidance.trajectory_id;
  snapshot_.role = role_;
  snapshot_.saturated = saturated_;
  snapshot_.timing = timing_.figures();
  snapshot_.loop_delay = loop_delay;
  snapshot_.setpoints = setpoints_;
  if (snapshots.push(snapshot_)) {
    last_snapshot_ = status;
    snapshot_requests_ = snapshot_.requests;
    snapshot_role_ = role_;
    saturated_ = false;
  }
  return true;
}

bool InnerLoop::status_changed() const {
  const control::Status& now = controller_.status();
  return now.mode != last_snapshot_.mode || now.reason != last_snapshot_.reason ||
         now.has_pose != last_snapshot_.has_pose || now.airborne != last_snapshot_.airborne ||
         now.ground_links != last_snapshot_.ground_links || now.mission.id != last_snapshot_.mission.id ||
         now.mission.state != last_snapshot_.mission.state ||
         now.mission.item_index != last_snapshot_.mission.item_index ||
         (now.gains_progress < 1.0) != (last_snapshot_.gains_progress < 1.0) ||
         differ_in_state(controller_.requests(), snapshot_requests_);
}

}  // namespace swiftlet::services
