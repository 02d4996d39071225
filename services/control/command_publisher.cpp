#include "swiftlet/services/control/command_publisher.hpp"

#include <variant>

#include "swiftlet/services/messages/convert.hpp"

namespace swiftlet::services {
namespace {

namespace topics = comms::topics;
using plant::ControlLevel;

std::size_t index(ControlLevel level) { return static_cast<std::size_t>(level); }

}  // namespace

CommandPublisher::CommandPublisher(comms::Node& node, std::uint32_t strength, int rotor_count)
    : node_(node),
      strength_(strength),
      rotor_count_(rotor_count),
      actuators_(node.publish(topics::kActuatorCommand, strength)) {
  open_[index(ControlLevel::kActuators)] = true;
}

void CommandPublisher::open(ControlLevel level) {
  if (open_[index(level)].load(std::memory_order_relaxed)) return;
  if (level == ControlLevel::kRates) rates_ = node_.publish(topics::kRatesSetpoint, strength_);
  if (level == ControlLevel::kAttitude) attitude_ = node_.publish(topics::kAttitudeSetpoint, strength_);
  if (level == ControlLevel::kTrajectory) trajectory_ = node_.publish(topics::kTrajectorySetpoint, strength_);
  open_[index(level)].store(true, std::memory_order_release);
}

void CommandPublisher::set_strength(std::uint32_t strength) {
  strength_ = strength;
  const auto is_open = [this](ControlLevel level) {
    return open_[index(level)].load(std::memory_order_relaxed);
  };
  actuators_.set_strength(strength);
  if (is_open(ControlLevel::kRates)) rates_.set_strength(strength);
  if (is_open(ControlLevel::kAttitude)) attitude_.set_strength(strength);
  if (is_open(ControlLevel::kTrajectory)) trajectory_.set_strength(strength);
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
  actuators_.publish(comms::to_message(command));
}
void CommandPublisher::publish_as(const plant::RatesSetpoint& setpoint) {
  rates_.publish(comms::to_message(setpoint));
}
void CommandPublisher::publish_as(const plant::AttitudeSetpoint& setpoint) {
  attitude_.publish(comms::to_message(setpoint));
}
void CommandPublisher::publish_as(const plant::TrajectorySetpoint& setpoint) {
  trajectory_.publish(comms::to_message(setpoint));
}

}  // namespace swiftlet::services
