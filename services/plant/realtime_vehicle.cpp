#include "swiftlet/services/plant/realtime_vehicle.hpp"

#include <cmath>

#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

std::int64_t scaled(std::int64_t simulated_ns, double speed) {
  return std::llround(static_cast<double>(simulated_ns) / speed);
}

}  // namespace

RealtimeVehicle::RealtimeVehicle(SimulatedVehicle& vehicle, const plant::SimulationSettings& settings,
                                 double speed, dds::Node& node, const runtime::RealtimeSettings& realtime)
    : vehicle_(vehicle),
      speed_(speed),
      steps_per_sample_(plant::period_ns(settings.imu.rate_hz) / settings.step_ns),
      sample_period_ns_(scaled(plant::period_ns(settings.imu.rate_hz), speed)),
      truth_(settings),
      realtime_(realtime),
      subscriptions_(subscribe_commands(node, settings.control_levels, dds::Delivery::kSamples,
                                        [this](const ReceivedCommand& received) { on_command(received); })),
      clock_(node, [this] { return simulated_ns(); }) {
  if (!vehicle.needs_poses()) return;
  subscriptions_.push_back(node.subscribe<messages::msg::MocapPose>(
      messages::topics::kMocapPose, [this](const auto& message) { on_pose(message); },
      dds::Delivery::kSensors));
}

void RealtimeVehicle::begin(std::int64_t tick_ns) {
  set_origin(tick_ns);
  publish();
}

// Makes the steps up to the next IMU sample at once, since each wake-up costs more than a step. Each obeys the commands that
// had arrived when it was due.
void RealtimeVehicle::step_to_sample(std::int64_t tick_ns, std::int64_t slipped_ns) {
  if (slipped_ns > 0) vehicle_.note_slip(slipped_ns);
  for (std::int64_t left = steps_per_sample_ - 1; left >= 0; --left) {
    const bool is_last = left == 0;
    const std::int64_t due_ns = tick_ns - sample_period_ns_ * left / steps_per_sample_;
    obey_due(due_ns, is_last);
    plant::PoseSample pose;
    if (pose_.take(pose)) vehicle_.on_pose(pose);
    vehicle_.step();
    publish();
    vehicle_.report();
  }
  if (slipped_ns > 0) set_origin(tick_ns);
}

void RealtimeVehicle::obey_due(std::int64_t due_ns, bool is_last) {
  while (commands_.read_available() > 0 && (is_last || commands_.front().received_ns <= due_ns)) {
    vehicle_.obey(commands_.front());
    commands_.pop();
  }
}

void RealtimeVehicle::publish() { vehicle_.publish_samples(truth_.due(vehicle_.simulation())); }

// tick_ns: when the last step was due.
void RealtimeVehicle::set_origin(std::int64_t tick_ns) {
  origin_ns_.store(tick_ns - scaled(vehicle_.simulation().stamp_ns(), speed_), std::memory_order_relaxed);
}

// The vehicle's clock, also between its steps.
std::optional<std::int64_t> RealtimeVehicle::simulated_ns() const {
  const std::int64_t origin_ns = origin_ns_.load(std::memory_order_relaxed);
  if (origin_ns == 0) return std::nullopt;
  return scaled(runtime::monotonic_ns() - origin_ns, 1.0 / speed_);
}

// Runs in the subscription's thread.
void RealtimeVehicle::on_command(const ReceivedCommand& received) {
  listener_.enter(realtime_);
  commands_.push(received);
}

void RealtimeVehicle::on_pose(const messages::msg::MocapPose& message) {
  plant::PoseSample pose;
  if (message.sequence_number() == 0 || messages::from_message(message, pose)) return;
  pose_.put(pose);
}

}  // namespace swiftlet::services
