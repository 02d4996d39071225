// Between the messages of the microcontroller and those of the topics. Neither allocates.
#pragma once

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/services/messages/topics.hpp"
#include "swiftlet/services/microcontroller/protocol/messages.hpp"

namespace swiftlet::services {

// The caller sets sequence_number. Numbers that are not finite are passed on: control refuses them and says so.
messages::msg::Imu to_message(const protocol::Imu& in);
messages::msg::RotorSpeeds to_message(const protocol::RotorSpeeds& in);
messages::msg::Battery to_message(const protocol::Battery& in);

// in: valid, as messages::from_message() leaves it.
protocol::Command to_wire(const plant::ActuatorCommand& in);

}  // namespace swiftlet::services
