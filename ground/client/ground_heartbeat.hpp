// Tells the vehicle that its flight depends on this tool: when the tool falls silent, the controller does
// what its settings say (failsafe.ground_link_action).
#pragma once

#include <cstdint>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// One thread at a time calls it.
class GroundHeartbeatPublisher {
 public:
  GroundHeartbeatPublisher(comms::Node& node, std::uint64_t client);
  ~GroundHeartbeatPublisher();  // takes leave
  GroundHeartbeatPublisher(const GroundHeartbeatPublisher&) = delete;
  GroundHeartbeatPublisher& operator=(const GroundHeartbeatPublisher&) = delete;

  // Telemetry of this stamp of the vehicle's clock was heard. By that clock a sign goes out every fifth of a
  // second, whatever the speed of the simulation: a tool that the vehicle's telemetry does not reach falls
  // silent.
  void telemetry(std::int64_t stamp_ns);

 private:
  void publish(bool depends);

  comms::msg::GroundLink heartbeat_;
  comms::Publisher<comms::msg::GroundLink> publisher_;
};

}  // namespace swiftlet::ground
