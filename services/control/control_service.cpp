#include "services/control/control_service.hpp"

#include <limits>

#include "services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

namespace msg = comms::msg;
namespace topics = comms::topics;
using comms::Delivery;

}  // namespace

ControlService::ControlService(const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                               int strength, comms::Node& node, const runtime::RealtimeSettings& realtime,
                               runtime::Clock clock)
    : realtime_(realtime),
      loop_(vehicle, settings),
      desk_(loop_, settings.limits, wake_),
      telemetry_(loop_, desk_, node, wake_),
      commands_(node.publish(topics::kActuatorCommand, strength)) {
  subscribe(node, clock);
}

void ControlService::subscribe(comms::Node& node, runtime::Clock clock) {
  using Stream = LockstepGate::Stream;
  std::function<void(const msg::MocapPose&)> take_pose;
  std::function<void(const msg::Battery&)> take_battery;
  std::function<void(const msg::RotorSpeeds&)> take_rotor_speeds;
  std::function<void(const msg::Imu&)> take_imu;
  // In real time nothing else may delay them; in lockstep a thread each would only cost wake-ups.
  const Delivery delivery = clock == runtime::Clock::kLockstep ? Delivery::kShared : Delivery::kOwnThread;
  if (clock == runtime::Clock::kLockstep) {
    take_pose = deliver_in_lockstep<msg::MocapPose>(loop_.pose, pose_faults_, Stream::kPose);
    take_battery = deliver_in_lockstep<msg::Battery>(loop_.battery, battery_faults_, Stream::kBattery);
    take_rotor_speeds =
        deliver_in_lockstep<msg::RotorSpeeds>(loop_.rotor_speeds, rotor_speed_faults_, Stream::kRotorSpeeds);
    take_imu = [this](const msg::Imu& message) { on_imu_in_lockstep(message); };
  } else {
    take_pose = deliver<msg::MocapPose>(loop_.pose, pose_faults_);
    take_battery = deliver<msg::Battery>(loop_.battery, battery_faults_);
    take_rotor_speeds = deliver<msg::RotorSpeeds>(loop_.rotor_speeds, rotor_speed_faults_);
    take_imu = [this](const msg::Imu& message) { on_imu(message); };
    telemetry_.watch_imu();
  }

  // Poses hold the vehicle in place: like the IMU's, their thread does not wait behind the host's other work.
  subscriptions_.push_back(node.subscribe<msg::MocapPose>(
      topics::kMocapPose,
      [this, take_pose](const auto& message) {
        if (!pose_thread_ready_) {
          pose_thread_ready_ = true;
          if (realtime_.enabled) runtime::make_this_thread_realtime(realtime_);
        }
        take_pose(message);
      },
      delivery));
  subscriptions_.push_back(node.subscribe<msg::Battery>(topics::kBattery, take_battery));
  subscriptions_.push_back(node.subscribe<msg::RotorSpeeds>(topics::kRotorSpeeds, take_rotor_speeds));
  subscriptions_.push_back(node.subscribe<msg::Setpoint>(
      topics::kSetpoint, deliver<msg::Setpoint>(loop_.setpoint, setpoint_faults_)));
  subscriptions_.push_back(node.subscribe<msg::GroundLink>(
      topics::kGroundLink, [this](const auto& message) { on_ground_link(message); }));
  subscriptions_.push_back(node.subscribe<msg::Command>(
      topics::kCommand, [this](const auto& message) { desk_.on_command(message); }));
  subscriptions_.push_back(node.subscribe<msg::Mission>(
      topics::kMission, [this](const auto& message) { desk_.on_mission(message); }, Delivery::kOwnThread));
  subscriptions_.push_back(node.subscribe<msg::Trajectory>(
      topics::kTrajectory, [this](const auto& message) { desk_.on_trajectory(message); },
      Delivery::kOwnThread));
  subscriptions_.push_back(node.subscribe<msg::Imu>(topics::kImu, take_imu, delivery));
}

// Hands a good sample to the inner loop.
template <class Message, class Sample>
std::function<void(const Message&)> ControlService::deliver(runtime::Mailbox<Sample>& mailbox,
                                                            comms::FaultLog& faults) {
  return [&mailbox, &faults](const Message& message) {
    Sample sample;
    const comms::Fault fault = comms::from_message(message, sample);
    if (fault) return faults.note(fault);
    mailbox.put(sample);
  };
}

// Number 0, motion capture's sign of life before its first frame, is never new.
template <class Message, class Sample>
std::function<void(const Message&)> ControlService::deliver_in_lockstep(runtime::Mailbox<Sample>& mailbox,
                                                                        comms::FaultLog& faults,
                                                                        LockstepGate::Stream stream) {
  return [this, stream, take = deliver<Message>(mailbox, faults)](const Message& message) {
    const std::lock_guard<std::mutex> lock(gate_mutex_);
    if (!gate_.is_new(stream, message.sequence_number())) return;
    take(message);
    if (const auto imu = gate_.take()) answer(*imu);
  };
}

// The hot path: from the sample to its command.
void ControlService::on_imu(const msg::Imu& message) {
  if (!imu_thread_ready_) {
    imu_thread_ready_ = true;
    if (realtime_.enabled) runtime::make_this_thread_realtime(realtime_);
    telemetry_.set_realtime(runtime::this_thread_is_realtime());
  }
  answer(message);
}

// What was answered before comes again while time stands still: requests are then looked at, and the answer
// is the same.
void ControlService::on_imu_in_lockstep(const msg::Imu& message) {
  const std::lock_guard<std::mutex> lock(gate_mutex_);
  if (!gate_.offer(message)) {
    loop_.judge_requests();
    commands_.publish(last_answer_);
    if (loop_.finish(runtime::monotonic_ns())) wake_.post();
  } else if (const auto imu = gate_.take()) {
    answer(*imu);
  }
}

// One that finds no room is said again.
void ControlService::on_ground_link(const msg::GroundLink& message) {
  control::GroundSign sign;
  const comms::Fault fault = comms::from_message(message, sign);
  if (fault) return ground_link_faults_.note(fault);
  loop_.ground_signs.push(sign);
}

void ControlService::answer(const msg::Imu& message) {
  const std::int64_t arrived_ns = runtime::monotonic_ns();
  plant::ImuSample sample;
  if (comms::from_message(message, sample)) {
    // The controller counts broken samples and acts on them: it has to see them as such.
    sample.stamp_ns = message.stamp_ns();
    sample.sequence = message.sequence_number();
    sample.specific_force_frd.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  last_answer_ = comms::to_message(loop_.step(sample, arrived_ns));
  commands_.publish(last_answer_);
  if (loop_.finish(runtime::monotonic_ns())) wake_.post();
}

void ControlService::run(const std::atomic<bool>& stop) { telemetry_.run(stop); }

}  // namespace swiftlet::services
