#include "tests/support/px4/scripted_px4.hpp"

#include <utility>

#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::tests {

ScriptedPx4::ScriptedPx4(const plant::Vehicle& vehicle, const dds::NodeSettings& network,
                         const ScriptedPx4Settings& settings)
    : settings_(settings),
      topics_(settings.instance, ""),
      status_topic_(topics_.folder, settings.status_topic),
      simulation_(vehicle, 1.0, settings.east_m),
      node_(network),
      sensors_(node_.publish(topics_.sensors.get())),
      odometry_(node_.publish(topics_.odometry.get())),
      battery_(node_.publish(topics_.battery.get())),
      status_(node_.publish(status_topic_.get())),
      land_detected_(node_.publish(topics_.land_detected.get())),
      flags_(node_.publish(topics_.failsafe_flags.get())),
      acks_(node_.publish(topics_.command_ack.get())),
      truth_(node_.publish(messages::topics::kGroundTruth)) {
  subscribe(topics_.offboard_control_mode, &Px4Simulation::on_offboard_mode);
  subscribe<px4_msg::VehicleRatesSetpoint>(topics_.rates_setpoint, &Px4Simulation::on_setpoint);
  subscribe<px4_msg::VehicleAttitudeSetpoint>(topics_.attitude_setpoint, &Px4Simulation::on_setpoint);
  subscribe<px4_msg::TrajectorySetpoint>(topics_.trajectory_setpoint, &Px4Simulation::on_setpoint);
  subscribe(topics_.visual_odometry, &Px4Simulation::on_pose);
  subscriptions_.push_back(
      node_.subscribe<px4_msg::VehicleCommand>(topics_.command.get(), [this](const auto& message) {
        std::optional<px4_msg::VehicleCommandAck> ack;
        {
          const std::lock_guard<std::mutex> lock(mutex_);
          ack = simulation_.on_command(message);
        }
        if (!ack) return;
        ack->timestamp(stamp_us());
        acks_.publish(*ack);
      }));
  thread_ = std::thread([this] { run(); });
}

ScriptedPx4::~ScriptedPx4() {
  stop_ = true;
  thread_.join();
  subscriptions_.clear();
}

template <class Message>
void ScriptedPx4::subscribe(const px4::Px4Topic<Message>& topic,
                            void (Px4Simulation::*take)(const Message&)) {
  subscriptions_.push_back(node_.subscribe<Message>(topic.get(), [this, take](const Message& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    (simulation_.*take)(message);
  }));
}

std::uint64_t ScriptedPx4::stamp_us() const {
  return static_cast<std::uint64_t>(runtime::system_ns() / 1000 - settings_.stamps_lag_us);
}

void ScriptedPx4::pilot_selects(std::uint8_t nav_state) {
  const std::lock_guard<std::mutex> lock(mutex_);
  simulation_.pilot_selects(nav_state);
}

void ScriptedPx4::run() {
  runtime::PeriodicTimer timer(Px4Simulation::kPeriodNs, 10 * Px4Simulation::kPeriodNs);
  while (!stop_) {
    timer.wait();
    std::unique_lock<std::mutex> lock(mutex_);
    Px4Messages messages = simulation_.advance(stamp_us());
    const plant::TruthSample truth = simulation_.truth();
    lock.unlock();
    publish(std::move(messages), truth);
  }
}

void ScriptedPx4::publish(Px4Messages messages, plant::TruthSample truth) {
  truth.sequence = ++truths_;
  truth.stamp_ns = runtime::monotonic_ns();
  truth_.publish(messages::to_message(truth));
  if (messages.sensors) sensors_.publish(*messages.sensors);
  odometry_.publish(messages.odometry);
  if (messages.battery) battery_.publish(*messages.battery);
  if (!messages.has_status) return;
  flags_.publish(messages.flags);
  land_detected_.publish(messages.land_detected);
  status_.publish(messages.status);
}

}  // namespace swiftlet::tests
