// A message of a type of others that follows from the vehicle's messages.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/record/mcap/records.hpp"
#include "swiftlet/services/messages/schemas.hpp"

namespace swiftlet::record {

struct StandardMessage {
  std::string topic;
  const messages::MessageSchema* schema = nullptr;
  mcap::Bytes payload;
};

struct StandardTopic {
  std::string topic;
  const messages::MessageSchema* schema = nullptr;
  std::vector<std::string> sources;  // the vehicle's topics that it follows from: "estimate"
  bool is_log = false;               // each message counts; of others the newest says it all
};

}  // namespace swiftlet::record
