#include "tests/support/spoiling_relay.hpp"

#include <utility>

namespace swiftlet::tests {

namespace topics = messages::topics;
namespace msg = messages::msg;

SpoilingRelay::SpoilingRelay(const dds::NodeSettings& from, const dds::NodeSettings& to, Spoil spoil)
    : spoil_(std::move(spoil)),
      from_(from),
      to_(to),
      imu_(to_.publish(topics::kImu)),
      battery_(to_.publish(topics::kBattery)),
      rotor_speeds_(to_.publish(topics::kRotorSpeeds)),
      info_(to_.publish(topics::kVehicleInfo)),
      commands_(from_.publish(topics::kActuatorCommand)),
      imu_in_(from_.subscribe<msg::Imu>(topics::kImu, [this](const msg::Imu& imu) { take_imu(imu); })),
      battery_in_(from_.subscribe<msg::Battery>(topics::kBattery,
                                                [this](msg::Battery battery) {
                                                  if (!spoil_.battery || spoil_.battery(battery))
                                                    battery_.publish(battery);
                                                })),
      rotor_speeds_in_(pass(topics::kRotorSpeeds, rotor_speeds_)),
      info_in_(pass(topics::kVehicleInfo, info_)),
      commands_in_(to_.subscribe<msg::ActuatorCommand>(
          topics::kActuatorCommand, [this](const msg::ActuatorCommand& command) { take_command(command); })) {
}

template <class T>
dds::Subscription SpoilingRelay::pass(const messages::Topic<T>& topic, dds::Publisher<T>& publisher) {
  return from_.subscribe<T>(topic, [&publisher](const T& message) { publisher.publish(message); });
}

void SpoilingRelay::take_imu(msg::Imu imu) {
  if (spoil_.repeats_last_command) {
    const std::lock_guard lock(mutex_);
    if (last_command_) {
      last_command_->stamp_ns(imu.stamp_ns());
      commands_.publish(*last_command_);
    }
  }
  if (!spoil_.imu || spoil_.imu(imu)) imu_.publish(imu);
}

void SpoilingRelay::take_command(msg::ActuatorCommand command) {
  if (spoil_.command && !spoil_.command(command)) return;
  const std::lock_guard lock(mutex_);
  last_command_ = command;
  if (!spoil_.repeats_last_command) commands_.publish(command);
}

}  // namespace swiftlet::tests
