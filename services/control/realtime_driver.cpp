#include "swiftlet/services/control/realtime_driver.hpp"

#include <algorithm>

#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

// Without IMU samples and without an active controller for this long, requests are answered: they are
// refused, with that reason.
constexpr std::int64_t kIsolationNs = 1'000'000'000;

}  // namespace

RealtimeDriver::RealtimeDriver(std::uint64_t controller, int failover_priority, InnerLoop& loop,
                               CommandServer& command_server, SampleAnswers& answers, Semaphore& wake,
                               dds::Node& node, const runtime::RealtimeSettings& realtime)
    : controller_(controller),
      realtime_(realtime),
      loop_(loop),
      command_server_(command_server),
      answers_(answers),
      wake_(wake),
      failover_(controller, failover_priority),
      command_term_(failover_.next_term()),
      active_heard_ns_(runtime::monotonic_ns()) {
  command_server_.set_active(false);
  controller_states_ = node.subscribe<messages::msg::ControllerState>(
      messages::topics::kControllerState, [this](const auto& message) { on_controller_state(message); },
      dds::Delivery::kPlans);
}

// The hot path: from the sample to its command.
void RealtimeDriver::on_sample(const VehicleSample& sample) {
  imu_thread_.enter(realtime_);
  if (sample.stamp_ns() == answered_ns_ && sample.sequence() == answered_) return answers_.repeat();
  answered_ns_ = sample.stamp_ns();
  answered_ = sample.sequence();
  answers_.answer(sample, take_role(sample));
}

// Poses are needed to hold position: their thread has real-time priority, like the IMU's.
void RealtimeDriver::on_sensor(Stream stream, std::uint64_t /*sequence*/, const std::function<void()>& put) {
  if (stream == &plant::LockstepInputs::mocap_pose) pose_thread_.enter(realtime_);
  if (stream == &plant::LockstepInputs::rotor_speeds) rotor_speed_thread_.enter(realtime_);
  put();
}

Authority RealtimeDriver::take_role(const VehicleSample& sample) {
  const Role before = failover_.role();
  heartbeats_.consume_all([this](const Heartbeat& beat) { failover_.heard(beat); });
  const std::int64_t now_ns = runtime::monotonic_ns();
  const Role role = failover_.sample(sample.stamp_ns(), sample.obeyed, now_ns);
  const bool active = role == Role::kActive;
  command_server_.set_active(active);
  active_.store(active, std::memory_order_relaxed);
  command_term_.store(active ? failover_.term() : failover_.next_term(), std::memory_order_relaxed);
  if (role != before) {
    const bool flew = sample.obeyed.reported && sample.obeyed.any;
    if (active && flew && !failover_.continues()) loop_.attempt_restart_in_air();
  }
  Takeover takeover;
  if (failover_.take_takeover(takeover)) {
    takeover_.put(takeover);
    wake_.post();
  }
  return {role, failover_.term(), failover_.followed_term(), failover_.loop_delay().figures()};
}

// The inner loop uses the other controllers' states from the next IMU sample on.
void RealtimeDriver::on_controller_state(const messages::msg::ControllerState& message) {
  if (message.controller() == controller_) return;
  messages::ControllerReport other;
  const messages::Fault fault = messages::from_message(message, other);
  if (fault) return faults_.note(fault);
  const std::int64_t now_ns = runtime::monotonic_ns();
  if (other.active) {
    active_heard_ns_.store(now_ns, std::memory_order_relaxed);
    if (!active_.load(std::memory_order_relaxed)) {
      FailoverState failover_state;
      failover_state.term = other.term;
      failover_state.flight = other.flight;
      command_server_.follow(failover_state);
    }
  }
  heartbeats_.push({other.controller, other.failover_priority, other.term,
                    other.active ? Role::kActive : Role::kStandby, now_ns});
}

void RealtimeDriver::attend() {
  Takeover takeover;
  if (takeover_.take(takeover)) runtime::log_warning("{}", to_string(takeover));
  const std::int64_t last_ns =
      std::max(loop_.last_arrival_ns(), active_heard_ns_.load(std::memory_order_relaxed));
  if (runtime::monotonic_ns() - last_ns > kIsolationNs) command_server_.set_active(true);
}

bool RealtimeDriver::is_realtime() const {
  return imu_thread_.is_realtime() && (pose_thread_.is_realtime() || !pose_thread_.has_entered());
}

}  // namespace swiftlet::services
