// Between the messages of the microcontroller and those of the topics. Neither allocates.
#pragma once

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/services/messages/topics.hpp"
#include "swiftlet/services/microcontroller/protocol/messages.hpp"

namespace swiftlet::services {

// The caller sets sequence_number. Numbers that are not finite are passed on: control refuses them and says so.
comms::msg::Imu to_message(const protocol::Imu& in);
comms::msg::RotorSpeeds to_message(const protocol::RotorSpeeds& in);
comms::msg::Battery to_message(const protocol::Battery& in);

// in: valid, as comms::from_message() leaves it.
protocol::Command to_wire(const plant::ActuatorCommand& in);

}  // namespace swiftlet::services
