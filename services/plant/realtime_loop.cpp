#include "swiftlet/services/plant/realtime_loop.hpp"

#include <cmath>

#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

std::int64_t scaled(std::int64_t simulated_ns, double speed) {
  return std::llround(static_cast<double>(simulated_ns) / speed);
}

}  // namespace

RealtimeLoop::RealtimeLoop(SimulatedVehicle& vehicle, const plant::SimulationSettings& settings, double speed,
                           comms::Node& node, const runtime::RealtimeSettings& realtime)
    : vehicle_(vehicle),
      step_ns_(scaled(settings.step_ns, speed)),
      imu_period_ns_(scaled(plant::period_ns(settings.imu.rate_hz), speed)),
      realtime_(realtime),
      commands_(node.subscribe<comms::msg::ActuatorCommand>(
          comms::topics::kActuatorCommand, [this](const auto& message) { on_command(message); },
          comms::Delivery::kOwnThread)) {}

void RealtimeLoop::run(const std::atomic<bool>& stop) {
  if (realtime_.enabled) runtime::make_this_thread_realtime(realtime_);
  runtime::PeriodicTimer timer(step_ns_, imu_period_ns_);
  vehicle_.publish_samples();
  while (!stop.load(std::memory_order_relaxed)) {
    const std::int64_t slipped_ns = timer.wait();
    if (slipped_ns > 0) vehicle_.note_slip(slipped_ns);
    received_.consume_all([this](const ReceivedCommand& received) { vehicle_.obey(received); });
    vehicle_.step();
    vehicle_.publish_samples();
    vehicle_.report();
  }
}

// Runs in the subscription's thread.
void RealtimeLoop::on_command(const comms::msg::ActuatorCommand& message) {
  listener_.enter(realtime_);
  received_.push(ReceivedCommand(message, runtime::monotonic_ns()));
}

}  // namespace swiftlet::services
