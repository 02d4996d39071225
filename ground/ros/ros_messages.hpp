// Messages of ROS 2 as payloads, and their writers and readers in the network of ROS 2.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ros {

using Bytes = std::vector<std::uint8_t>;

// A message of the type that Type::kName names, on the wire; CDR with the encapsulation header.
template <class Type>
struct Message {
  Bytes payload;
};

struct PoseStamped {
  static constexpr const char* kName = "geometry_msgs::msg::dds_::PoseStamped_";
};
struct Twist {
  static constexpr const char* kName = "geometry_msgs::msg::dds_::Twist_";
};
struct Path {
  static constexpr const char* kName = "nav_msgs::msg::dds_::Path_";
};
struct Odometry {
  static constexpr const char* kName = "nav_msgs::msg::dds_::Odometry_";
};
struct Imu {
  static constexpr const char* kName = "sensor_msgs::msg::dds_::Imu_";
};
struct BatteryState {
  static constexpr const char* kName = "sensor_msgs::msg::dds_::BatteryState_";
};
struct Transforms {
  static constexpr const char* kName = "tf2_msgs::msg::dds_::TFMessage_";
};
struct Clock {
  static constexpr const char* kName = "rosgraph_msgs::msg::dds_::Clock_";
};

// A writer of one topic: returns false if the message was not sent.
using Writer = std::function<bool(Bytes)>;

// name: "pose" in the namespace of the node's vehicle, "/tf" outside. qos: kLatched or kLatchedLarge, which match all
// readers of ROS 2. Throws std::runtime_error.
template <class Type>
Writer writer(comms::Node& node, const std::string& name, comms::Qos qos = comms::Qos::kLatched);

// The writer of a topic of the type that ROS 2 calls "geometry_msgs/msg/PoseStamped". Throws std::logic_error for a type
// that is not one of the above.
Writer writer_of(comms::Node& node, const std::string& name, const std::string& ros_type);

// A reader of one topic. Throws std::runtime_error.
template <class Type>
class Reader {
 public:
  Reader(comms::Node& node, const std::string& name, comms::Qos qos,
         std::function<void(const Bytes&)> callback);

 private:
  std::unique_ptr<const std::string> name_;  // outlives the subscription
  comms::Subscription subscription_;
};

}  // namespace swiftlet::ros
