#include "services/control/control_service.hpp"

#include <limits>

#include <spdlog/spdlog.h>

#include "services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

namespace msg = comms::msg;
namespace topics = comms::topics;
using comms::Delivery;

// Hands a good sample to the inner loop.
template <class Message, class Sample>
auto deliver(runtime::Mailbox<Sample>& mailbox, comms::FaultLog& faults) {
  return [&mailbox, &faults](const Message& message) {
    Sample sample;
    const comms::Fault fault = comms::from_message(message, sample);
    if (fault) return faults.note(fault);
    mailbox.put(sample);
  };
}

}  // namespace

ControlService::ControlService(const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                               int strength, comms::Node& node, const runtime::RealtimeSettings& realtime)
    : realtime_(realtime),
      loop_(vehicle, settings),
      desk_(loop_, settings.limits, wake_),
      telemetry_(loop_, desk_, node, wake_),
      commands_(node.publish(topics::kActuatorCommand, strength)) {
  subscribe(node);
}

void ControlService::subscribe(comms::Node& node) {
  // Poses hold the vehicle in place: like the IMU's, their thread does not wait behind the host's other work.
  const auto take_pose = deliver<msg::MocapPose>(loop_.pose, pose_faults_);
  subscriptions_.push_back(node.subscribe<msg::MocapPose>(
      topics::kMocapPose,
      [this, take_pose](const auto& message) {
        if (!pose_thread_ready_) {
          pose_thread_ready_ = true;
          if (realtime_.enabled) runtime::make_this_thread_realtime(realtime_);
        }
        take_pose(message);
      },
      {}, Delivery::kOwnThread));
  subscriptions_.push_back(
      node.subscribe<msg::Battery>(topics::kBattery, deliver<msg::Battery>(loop_.battery, battery_faults_)));
  subscriptions_.push_back(node.subscribe<msg::RotorSpeeds>(
      topics::kRotorSpeeds, deliver<msg::RotorSpeeds>(loop_.rotor_speeds, rotor_speed_faults_)));
  subscriptions_.push_back(node.subscribe<msg::Setpoint>(
      topics::kSetpoint, deliver<msg::Setpoint>(loop_.setpoint, setpoint_faults_)));
  subscriptions_.push_back(node.subscribe<msg::Command>(
      topics::kCommand, [this](const auto& message) { desk_.on_command(message); }));
  subscriptions_.push_back(node.subscribe<msg::Mission>(
      topics::kMission, [this](const auto& message) { desk_.on_mission(message); }, {},
      Delivery::kOwnThread));
  subscriptions_.push_back(node.subscribe<msg::Trajectory>(
      topics::kTrajectory, [this](const auto& message) { desk_.on_trajectory(message); }, {},
      Delivery::kOwnThread));
  subscriptions_.push_back(node.subscribe<msg::Imu>(
      topics::kImu, [this](const auto& message) { on_imu(message); },
      [] { spdlog::warn("no IMU sample for {} ms", topics::kImu.deadline_ms); }, Delivery::kOwnThread));
}

// The hot path: from the sample to its command.
void ControlService::on_imu(const msg::Imu& message) {
  const std::int64_t arrived_ns = runtime::monotonic_ns();
  if (!imu_thread_ready_) {
    imu_thread_ready_ = true;
    if (realtime_.enabled) runtime::make_this_thread_realtime(realtime_);
    telemetry_.set_realtime(runtime::this_thread_is_realtime());
  }
  plant::ImuSample sample;
  if (comms::from_message(message, sample)) {
    // The controller counts broken samples and acts on them: it has to see them as such.
    sample.stamp_ns = message.stamp_ns();
    sample.sequence = message.sequence_number();
    sample.specific_force_frd.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  commands_.publish(comms::to_message(loop_.step(sample, arrived_ns)));
  if (loop_.finish(runtime::monotonic_ns())) wake_.post();
}

void ControlService::run(const std::atomic<bool>& stop) { telemetry_.run(stop); }

}  // namespace swiftlet::services
