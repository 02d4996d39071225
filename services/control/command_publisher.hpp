// Publishes the commands at the level at which the vehicle is commanded: each level has a topic of its own.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/plant/model/vehicle_command.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::services {

class CommandPublisher {
 public:
  // Level actuators is open from the start.
  CommandPublisher(dds::Node& node, int rotor_count);

  // Creates the topic of a level. Call from one thread.
  void open(plant::ControlLevel level);

  // While the topic of the command's level is not open, the vehicle's levels are not known: a command of rotors off then
  // goes out at level actuators, others do not. Two threads publish: that of the IMU samples, and while there are none
  // that of the telemetry. Neither waits for the other: a sample whose command is left out for that reason counts as
  // unanswered at the vehicle. Does not allocate.
  void publish(const plant::VehicleCommand& command);

 private:
  void publish_as(const plant::ActuatorCommand& command);
  void publish_as(const plant::RatesSetpoint& setpoint);
  void publish_as(const plant::AttitudeSetpoint& setpoint);
  void publish_as(const plant::TrajectorySetpoint& setpoint);

  dds::Node& node_;
  const int rotor_count_;
  std::array<std::atomic<bool>, plant::kControlLevelCount> open_{};
  std::atomic_flag in_use_ = ATOMIC_FLAG_INIT;
  dds::Publisher<messages::msg::ActuatorCommand> actuators_;
  dds::Publisher<messages::msg::RatesSetpoint> rates_;
  dds::Publisher<messages::msg::AttitudeSetpoint> attitude_;
  dds::Publisher<messages::msg::TrajectorySetpoint> trajectory_;
};

}  // namespace swiftlet::services
