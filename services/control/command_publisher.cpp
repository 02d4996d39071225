#include "swiftlet/services/control/command_publisher.hpp"

#include <variant>

#include "swiftlet/services/messages/convert.hpp"

namespace swiftlet::services {
namespace {

namespace topics = messages::topics;
using plant::ControlLevel;

std::size_t index(ControlLevel level) { return static_cast<std::size_t>(level); }

}  // namespace

CommandPublisher::CommandPublisher(dds::Node& node, int rotor_count)
    : node_(node), rotor_count_(rotor_count), actuators_(node.publish(topics::kActuatorCommand)) {
  open_[index(ControlLevel::kActuators)] = true;
}

void CommandPublisher::open(ControlLevel level) {
  if (open_[index(level)].load(std::memory_order_relaxed)) return;
  if (level == ControlLevel::kRates) rates_ = node_.publish(topics::kRatesSetpoint);
  if (level == ControlLevel::kAttitude) attitude_ = node_.publish(topics::kAttitudeSetpoint);
  if (level == ControlLevel::kTrajectory) trajectory_ = node_.publish(topics::kTrajectorySetpoint);
  open_[index(level)].store(true, std::memory_order_release);
}

void CommandPublisher::publish(const plant::VehicleCommand& command) {
  if (in_use_.test_and_set(std::memory_order_acquire)) return;
  if (open_[command.index()].load(std::memory_order_acquire)) {
    std::visit([this](const auto& one) { publish_as(one); }, command);
  } else if (plant::header_of(command).rotor_state == plant::RotorState::kOff) {
    publish_as(std::get<plant::ActuatorCommand>(
        plant::rotors_off(ControlLevel::kActuators, plant::header_of(command), rotor_count_)));
  }
  in_use_.clear(std::memory_order_release);
}

void CommandPublisher::publish_as(const plant::ActuatorCommand& command) {
  actuators_.publish(messages::to_message(command));
}
void CommandPublisher::publish_as(const plant::RatesSetpoint& setpoint) {
  rates_.publish(messages::to_message(setpoint));
}
void CommandPublisher::publish_as(const plant::AttitudeSetpoint& setpoint) {
  attitude_.publish(messages::to_message(setpoint));
}
void CommandPublisher::publish_as(const plant::TrajectorySetpoint& setpoint) {
  trajectory_.publish(messages::to_message(setpoint));
}

}  // namespace swiftlet::services
