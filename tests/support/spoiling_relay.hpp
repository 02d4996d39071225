// Passes the topics of one vehicle on as those of another, and the commands back, with defects that a vehicle may have.
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::tests {

// Each may change the message; returns false to drop it.
struct Spoil {
  std::function<bool(comms::msg::Imu&)> imu{};
  std::function<bool(comms::msg::Battery&)> battery{};
  std::function<bool(comms::msg::ActuatorCommand&)> command{};
  bool repeats_last_command =
      false;  // answers each IMU sample with the last command, whether there is a newer one or not
};

class SpoilingRelay {
 public:
  // from: the vehicle that lives; to: the same with the name under which it is seen.
  SpoilingRelay(const comms::NodeSettings& from, const comms::NodeSettings& to, Spoil spoil);

 private:
  template <class T>
  comms::Subscription pass(const comms::Topic<T>& topic, comms::Publisher<T>& publisher);
  void take_imu(comms::msg::Imu imu);
  void take_command(comms::msg::ActuatorCommand command);

  Spoil spoil_;
  std::mutex mutex_;  // guards last_command_ and the publisher of commands
  std::optional<comms::msg::ActuatorCommand> last_command_;
  comms::Node from_, to_;
  comms::Publisher<comms::msg::Imu> imu_;
  comms::Publisher<comms::msg::Battery> battery_;
  comms::Publisher<comms::msg::RotorSpeeds> rotor_speeds_;
  comms::Publisher<comms::msg::VehicleInfo> info_;
  comms::Publisher<comms::msg::ActuatorCommand> commands_;
  // Last: their callbacks use all members above.
  comms::Subscription imu_in_, battery_in_, rotor_speeds_in_, info_in_, commands_in_;
};

}  // namespace swiftlet::tests
