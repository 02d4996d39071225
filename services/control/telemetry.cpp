#include "swiftlet/services/control/telemetry.hpp"

#include <algorithm>

#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

namespace topics = messages::topics;

constexpr std::int64_t kStatusPeriodNs = 100'000'000;
constexpr std::int64_t kMissionPeriodNs = 500'000'000;

bool differ(const control::MissionProgress& a, const control::MissionProgress& b) {
  return a.id != b.id || a.state != b.state || a.item_index != b.item_index || a.item_count != b.item_count;
}

bool is_over(control::MissionState state) {
  return state == control::MissionState::kCompleted || state == control::MissionState::kAborted;
}

void show_stop(const control::RequestKey& key, messages::msg::ControlStatus& message) {
  message.mode(static_cast<std::uint8_t>(control::Mode::kStopped));
  message.reason() = "emergency stop is active, but the vehicle is silent and cannot confirm it";
  auto& earlier = message.earlier_requests();
  std::rotate(earlier.begin(), earlier.end() - 1, earlier.end());
  earlier.front() = message.request();
  control::RequestStatus stop;
  stop.key = key;
  stop.kind = control::RequestKind::kStop;
  stop.state = control::RequestState::kAccepted;
  message.request() = messages::to_message(stop);
}

}  // namespace

Telemetry::Telemetry(InnerLoop& loop, CommandServer& command_server,
                     const control::FailsafeSettings& thresholds, dds::Node& node, std::uint64_t controller,
                     const control::ObservedRotors& rotors)
    : loop_(loop),
      command_server_(command_server),
      thresholds_(thresholds),
      node_(node),
      controller_(controller),
      delay_monitor_(rotors),
      estimates_(node.publish(topics::kEstimate)),
      references_(node.publish(topics::kReference)),
      acks_(node.publish(topics::kCommandAck)) {
  open();
}

// Creates the latched publishers anew, without a last sample.
void Telemetry::open() {
  statuses_ = node_.publish(topics::kControlStatus);
  missions_ = node_.publish(topics::kMissionStatus);
  flown_missions_ = node_.publish(topics::kFlownMission);
  flown_trajectories_ = node_.publish(topics::kFlownTrajectory);
  published_mission_ = 0;
  published_trajectory_ = 0;
}

void Telemetry::set_conditions(bool realtime, const std::string& source_conflict) {
  realtime_ = realtime;
  if (source_conflict_.empty() && !source_conflict.empty()) runtime::log_warning("{}", source_conflict);
  source_conflict_ = source_conflict;
}

void Telemetry::set_unconfirmed_stop(const std::optional<control::RequestKey>& stop) {
  if (stop.has_value() != unconfirmed_stop_.has_value()) status_due_ns_ = 0;
  unconfirmed_stop_ = stop;
}

void Telemetry::publish_due() {
  const bool any = loop_.snapshots.consume_all([this](const Snapshot& snapshot) { take(snapshot); }) > 0;
  if (any) command_server_.set_gains_in_force(last_.gains);
  const std::vector<messages::msg::CommandAck> answers = command_server_.collect();
  if (last_.role == Role::kActive) publish_plan();  // before its acceptance is published
  for (const messages::msg::CommandAck& answer : answers) acks_.publish(answer);
  const std::int64_t now_ns = runtime::monotonic_ns();
  if (watches_imu_) log_imu_silence();
  if (!command_server_.active()) return;
  if (now_ns >= status_due_ns_) publish_status();
  if (now_ns >= mission_due_ns_) publish_mission();
}

// A standby drops its latched samples: late joiners must receive those of the active controller only.
void Telemetry::change_role() {
  runtime::log_info("role is {}, mode {}", to_string(last_.role), control::to_string(last_.status.mode));
  if (last_.role == Role::kStandby) return open();
  publish_status();
  publish_mission();
}

void Telemetry::publish_plan() {
  const std::uint64_t mission = last_.status.mission.id;
  if (mission != 0 && mission != published_mission_) {
    const messages::msg::Mission message = command_server_.mission(mission);
    if (message.id() == mission) flown_missions_.publish(message);
    published_mission_ = mission;
  }
  const std::uint64_t trajectory = last_.status.mode == control::Mode::kTrajectory ? last_.trajectory_id : 0;
  if (trajectory != 0 && trajectory != published_trajectory_) {
    const messages::msg::Trajectory message = command_server_.trajectory(trajectory);
    if (message.id() == trajectory) flown_trajectories_.publish(message);
    published_trajectory_ = trajectory;
  }
}

void Telemetry::take(const Snapshot& snapshot) {
  const bool role_changed = snapshot.role != last_.role;
  if (snapshot.role == Role::kStandby) {
    last_ = snapshot;
    update_delay();  // the margin of new gains takes time, which a takeover must not
    if (role_changed) change_role();
    return;
  }
  const control::Status& before = last_.status;
  const control::Status& now = snapshot.status;
  const bool mode_changed = now.mode != before.mode || now.reason != before.reason;
  const bool requests_changed = control::differ_in_state(snapshot.requests, last_.requests);
  const bool mission_changed = differ(now.mission, before.mission);
  if (mission_changed) {
    mission_end_code_ = is_over(now.mission.state) ? static_cast<std::uint8_t>(now.reason) : std::uint8_t{0};
    mission_end_ = is_over(now.mission.state) ? reason_text(now) : "";
  }
  if (mode_changed) runtime::log_info("{}: {}", control::to_string(now.mode), reason_text(now));
  if (now.has_pose != before.has_pose) {
    if (now.has_pose) {
      runtime::log_info("mocap available");
    } else {
      runtime::log_warning("mocap lost: the last pose is {:.2f} s old", now.pose_age_s);
    }
  }
  if (now.odometry.in_force != before.odometry.in_force)
    runtime::log_info("flown by the {}",
                      now.odometry.in_force ? "vehicle's own estimate" : "estimate of motion capture");
  if (now.odometry.resets != before.odometry.resets)
    runtime::log_warning("the vehicle's own estimate has jumped, {} times in all", now.odometry.resets);
  if (now.level != before.level)
    runtime::log_info("commands the vehicle at level {}", plant::to_string(now.level));
  if (now.ground_links != before.ground_links)
    runtime::log_info("link-loss failsafe watches {} ground tools", now.ground_links);
  if ((now.gains_progress < 1.0) != (before.gains_progress < 1.0))
    runtime::log_info("{} the gains of {}", now.gains_progress < 1.0 ? "changing to" : "flying with",
                      now.settings.data());
  if (snapshot.sampled) publish_sampled(snapshot);
  saturated_ = saturated_ || snapshot.saturated;
  last_ = snapshot;
  if (role_changed) return change_role();
  if (mode_changed || requests_changed) publish_status();
  if (mission_changed) publish_mission();
}

void Telemetry::set_vehicle_fault(const std::string& fault) {
  const std::lock_guard<std::mutex> lock(vehicle_fault_mutex_);
  if (!fault.empty()) vehicle_fault_ = fault;
}

std::string Telemetry::reason_text(const control::Status& status) const {
  if (status.reason == control::Reason::kHoverTestFailed && status.hover_test_defect[0] != '\0')
    return status.hover_test_defect.data();
  if (status.reason != control::Reason::kVehicleFault) return control::to_string(status.reason);
  const std::lock_guard<std::mutex> lock(vehicle_fault_mutex_);
  return vehicle_fault_;
}

void Telemetry::log_imu_silence() {
  const bool silent = ages_.imu_s > kImuSilence_s;
  if (silent && !imu_silent_) runtime::log_warning("no IMU sample for {:.0f} ms", 1e3 * ages_.imu_s);
  imu_silent_ = silent;
}

void Telemetry::publish_sampled(const Snapshot& snapshot) {
  ++sampled_count_;
  messages::msg::Estimate estimate =
      messages::to_message(snapshot.estimate, snapshot.estimate_deviation, snapshot.status.pose_age_s);
  estimate.sequence_number(sampled_count_);
  estimates_.publish(estimate);
  messages::msg::Reference reference =
      messages::to_message(snapshot.reference, snapshot.setpoint, snapshot.status.mode);
  reference.stamp_ns(snapshot.stamp_ns);
  reference.sequence_number(sampled_count_);
  references_.publish(reference);
}

const DelayMonitor::Report& Telemetry::update_delay() {
  return delay_monitor_.update(last_.loop_delay, last_.gains, last_.status.gains_progress >= 1.0);
}

void Telemetry::publish_status() {
  const control::Status& status = last_.status;
  messages::msg::ControlStatus message = messages::to_message(status, last_.gains, thresholds_);
  message.stamp_ns(last_.stamp_ns);
  message.sequence_number(++status_count_);
  message.reason() = reason_text(status);
  // The controller's own age of the pose stands still while no IMU sample arrives.
  const double pose_age_s = status.pose_age_s + (ages_.imu_s > kImuSilence_s ? ages_.imu_s : 0.0);
  message.has_pose(status.has_pose && pose_age_s <= thresholds_.mocap_timeout_s);
  message.pose_age_s(pose_age_s);
  message.imu_age_s(ages_.imu_s);
  message.mocap_age_s(ages_.pose_s);
  message.battery_age_s(ages_.battery_s);
  message.source_conflict() = source_conflict_.c_str();
  message.saturated(saturated_);
  message.cycles(last_.timing.cycles);
  message.deadline_misses(last_.timing.deadline_misses);
  message.rate_hz(last_.timing.rate_hz);
  message.step_time_max_us(static_cast<double>(last_.timing.longest_ns) * 1e-3);
  message.period_jitter_p50_us(static_cast<double>(last_.timing.jitter_p50_ns) * 1e-3);
  message.period_jitter_p99_us(static_cast<double>(last_.timing.jitter_p99_ns) * 1e-3);
  message.period_jitter_max_us(static_cast<double>(last_.timing.jitter_max_ns) * 1e-3);
  message.setpoints_accepted(last_.setpoints.accepted);
  message.setpoints_refused(last_.setpoints.refused);
  message.setpoint_refusal() = last_.setpoints.refusal.reason;
  const DelayMonitor::Report& delay = update_delay();
  message.loop_delay_p50_s(delay.p50_s);
  message.loop_delay_p95_s(delay.p95_s);
  message.delay_margin_s(delay.margin_s);
  message.delay_near_margin(delay.near_margin);
  message.realtime_scheduling(realtime_);
  message.controller(controller_);
  const control::RequestStatuses& requests = last_.requests;
  message.request() = messages::to_message(requests.back());
  for (std::size_t i = 0; i < message.earlier_requests().size(); ++i)
    message.earlier_requests()[i] = messages::to_message(requests[requests.size() - 2 - i]);
  if (unconfirmed_stop_) show_stop(*unconfirmed_stop_, message);
  statuses_.publish(message);
  saturated_ = false;
  status_due_ns_ = runtime::monotonic_ns() + kStatusPeriodNs;
}

void Telemetry::publish_mission() {
  messages::msg::MissionStatus message = messages::to_message(last_.status.mission);
  message.stamp_ns(last_.stamp_ns);
  message.sequence_number(++mission_count_);
  message.reason_code(mission_end_code_);
  message.reason() = mission_end_;
  missions_.publish(message);
  mission_due_ns_ = runtime::monotonic_ns() + kMissionPeriodNs;
}

}  // namespace swiftlet::services
