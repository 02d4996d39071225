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
  std::function<bool(messages::msg::Imu&)> imu{};
  std::function<bool(messages::msg::Battery&)> battery{};
  std::function<bool(messages::msg::ActuatorCommand&)> command{};
  bool repeats_last_command =
      false;  // answers each IMU sample with the last command, whether there is a newer one or not
};

class SpoilingRelay {
 public:
  // from: the vehicle that lives; to: the same with the name under which it is seen.
  SpoilingRelay(const dds::NodeSettings& from, const dds::NodeSettings& to, Spoil spoil);

 private:
  template <class T>
  dds::Subscription pass(const messages::Topic<T>& topic, dds::Publisher<T>& publisher);
  void take_imu(messages::msg::Imu imu);
  void take_command(messages::msg::ActuatorCommand command);

  Spoil spoil_;
  std::mutex mutex_;  // guards last_command_ and the publisher of commands
  std::optional<messages::msg::ActuatorCommand> last_command_;
  dds::Node from_, to_;
  dds::Publisher<messages::msg::Imu> imu_;
  dds::Publisher<messages::msg::Battery> battery_;
  dds::Publisher<messages::msg::RotorSpeeds> rotor_speeds_;
  dds::Publisher<messages::msg::VehicleInfo> info_;
  dds::Publisher<messages::msg::ActuatorCommand> commands_;
  // Last: their callbacks use all members above.
  dds::Subscription imu_in_, battery_in_, rotor_speeds_in_, info_in_, commands_in_;
};

}  // namespace swiftlet::tests
