// Publishes recorded payloads on the topics of a vehicle.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "swiftlet/record/mcap/records.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

class TopicPublishers {
 public:
  // names: of topics, "imu"; others are ignored. Throws std::runtime_error.
  TopicPublishers(dds::Node& node, const std::set<std::string>& names);

  // Returns false if the payload is no message of the topic, or was not sent.
  bool publish(const std::string& name, mcap::ByteView payload);
  // True if each topic has a reader.
  bool matched() const;
  // Waits until all matched readers of a reliable topic have all samples. Returns false after the timeout.
  bool wait_until_received(const std::string& name, std::chrono::milliseconds timeout);

 private:
  struct Topic {
    std::function<bool()> matched;
    std::function<bool(mcap::ByteView)> publish;
    std::function<bool(std::chrono::milliseconds)> wait_until_received;
  };
  std::map<std::string, Topic> topics_;
};

}  // namespace swiftlet::ground
