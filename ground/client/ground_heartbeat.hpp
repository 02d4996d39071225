// Publishes the ground heartbeat (topic ground_link): if it stops, the controller's link-loss failsafe does
// what failsafe.ground_link_action says.
#pragma once

#include <cstdint>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// Not thread-safe.
class GroundHeartbeatPublisher {
 public:
  GroundHeartbeatPublisher(dds::Node& node, std::uint64_t client);
  // Ends the failsafe: publishes `depends` = false several times, within 0.1 s.
  ~GroundHeartbeatPublisher();
  GroundHeartbeatPublisher(const GroundHeartbeatPublisher&) = delete;
  GroundHeartbeatPublisher& operator=(const GroundHeartbeatPublisher&) = delete;

  // Call with the stamp of each received telemetry sample. Publishes a heartbeat every 0.05 s of the vehicle's
  // clock, at any speed of the simulation. A tool that receives no telemetry sends no heartbeat.
  void telemetry(std::int64_t stamp_ns);

 private:
  void publish(bool depends);

  messages::msg::GroundLink heartbeat_;
  dds::Publisher<messages::msg::GroundLink> publisher_;
};

}  // namespace swiftlet::ground
