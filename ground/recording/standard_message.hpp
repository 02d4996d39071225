// A message of a type of others that follows from the vehicle's messages.
#pragma once

#include <string>

#include "swiftlet/io/mcap/records.hpp"
#include "swiftlet/services/messages/schemas.hpp"

namespace swiftlet::ground {

struct StandardMessage {
  std::string topic;
  const comms::MessageSchema* schema = nullptr;
  mcap::Bytes payload;
};

}  // namespace swiftlet::ground
