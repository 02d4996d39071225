// Shows the processes of the domain to ROS 2 as nodes.
#pragma once

#include <cstddef>
#include <memory>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ros {

// Bytes of an endpoint's number in ros_discovery_info, which differ between distributions of ROS 2.
constexpr std::size_t kGidBytes = 16;
constexpr std::size_t kGidBytesOfHumble = 24;

// ROS 2 knows a node from a message of the topic ros_discovery_info: its namespace and name, and the writers and readers that
// are its. Swiftlet's processes send none; this object does for each that it discovers, also for its own. The process
// "control" that serves kl1 and kl2 becomes the nodes /kl1/control and /kl2/control, each with the endpoints of its vehicle.
class RosGraph {
 public:
  // Joins the domain with a participant of its own. Throws std::runtime_error.
  RosGraph(dds::NodeSettings settings, std::size_t gid_bytes);
  ~RosGraph();
  RosGraph(const RosGraph&) = delete;
  RosGraph& operator=(const RosGraph&) = delete;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace swiftlet::ros
