#include "services/control/inner_loop.hpp"

#include "services/runtime/telemetry_rate.hpp"

namespace swiftlet::services {
InnerLoop::InnerLoop(const plant::Vehicle& vehicle, const control::ControlSettings& settings)
    : controller_(vehicle, settings) {}

plant::ActuatorCommand InnerLoop::step(const plant::ImuSample& sample, std::int64_t now_ns) {
  last_arrival_ns_.store(now_ns, std::memory_order_relaxed);
  take_samples();
  hear_ground();
  judge_requests();
  const plant::ActuatorCommand command = controller_.on_imu(sample);
  rotors_running_ = command.rotor_state == plant::RotorState::kRunning;
  stamp_ns_ = sample.stamp_ns;
  imu_sequence_ = sample.sequence;
  timing_.arrived(sample.sequence, sample.stamp_ns, now_ns, rotors_running_);
  return command;
}

void InnerLoop::take_samples() {
  plant::PoseSample new_pose;
  if (pose.take(new_pose)) controller_.on_pose(new_pose);
  plant::BatterySample new_battery;
  if (battery.take(new_battery)) controller_.on_battery(new_battery);
  plant::RotorSpeedSample new_rotor_speeds;
  if (rotor_speeds.take(new_rotor_speeds)) controller_.on_rotor_speeds(new_rotor_speeds);
  control::Setpoint new_setpoint;
  if (setpoint.take(new_setpoint)) controller_.on_setpoint(new_setpoint);
}

void InnerLoop::hear_ground() {
  ground_signs.consume_all([this](const control::GroundSign& sign) { controller_.on_ground_sign(sign); });
}

void InnerLoop::judge_requests() {
  PendingRequest* pending = nullptr;
  while (requests.pop(pending)) {
    if (pending->claim(PendingRequest::State::kTaken))
      pending->outcome = controller_.request(pending->request);
    judged.push(pending);  // fits: no more are under way
    judged_any_ = true;
  }
}

bool InnerLoop::finish(std::int64_t now_ns) {
  timing_.answered(now_ns);
  const control::Status& status = controller_.status();
  saturated_ = saturated_ || status.saturated;
  const bool sampled =
      timing_.period_ns() > 0 && runtime::is_telemetry_sample(imu_sequence_, timing_.period_ns());
  const bool answers = judged_any_;
  judged_any_ = false;
  if (!sampled && !status_changed()) return answers;

  snapshot_.stamp_ns = stamp_ns_;
  snapshot_.sampled = sampled;
  snapshot_.estimate = controller_.estimate();
  snapshot_.reference = controller_.reference();
  snapshot_.setpoint = controller_.attitude_setpoint();
  snapshot_.status = status;
  snapshot_.saturated = saturated_;
  snapshot_.timing = timing_.figures();
  if (snapshots.push(snapshot_)) {
    told_ = status;
    saturated_ = false;
  }
  return true;
}

bool InnerLoop::status_changed() const {
  const control::Status& now = controller_.status();
  return now.mode != told_.mode || now.reason != told_.reason || now.has_pose != told_.has_pose ||
         now.airborne != told_.airborne || now.ground_links != told_.ground_links ||
         now.mission.id != told_.mission.id || now.mission.state != told_.mission.state ||
         now.mission.item_index != told_.mission.item_index;
}

}  // namespace swiftlet::services
