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

// A message of the type that Type::kName names, on the wire, and Type::kTypeHash for ROS 2; CDR with the encapsulation
// header.
template <class Type>
struct Message {
  Bytes payload;
};

struct PoseStamped {
  static constexpr const char* kName = "geometry_msgs::msg::dds_::PoseStamped_";
  static constexpr const char* kTypeHash =
      "RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8";
};
struct Twist {
  static constexpr const char* kName = "geometry_msgs::msg::dds_::Twist_";
  static constexpr const char* kTypeHash =
      "RIHS01_9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a";
};
struct Path {
  static constexpr const char* kName = "nav_msgs::msg::dds_::Path_";
  static constexpr const char* kTypeHash =
      "RIHS01_1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b";
};
struct Odometry {
  static constexpr const char* kName = "nav_msgs::msg::dds_::Odometry_";
  static constexpr const char* kTypeHash =
      "RIHS01_3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0";
};
struct Imu {
  static constexpr const char* kName = "sensor_msgs::msg::dds_::Imu_";
  static constexpr const char* kTypeHash =
      "RIHS01_7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b";
};
struct BatteryState {
  static constexpr const char* kName = "sensor_msgs::msg::dds_::BatteryState_";
  static constexpr const char* kTypeHash =
      "RIHS01_4bee5dfce981c98faa6828b868307a0a73f992ed0789f374ee96c8f840e69741";
};
struct Transforms {
  static constexpr const char* kName = "tf2_msgs::msg::dds_::TFMessage_";
  static constexpr const char* kTypeHash =
      "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087";
};
struct Clock {
  static constexpr const char* kName = "rosgraph_msgs::msg::dds_::Clock_";
  static constexpr const char* kTypeHash =
      "RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564";
};

// A writer of one topic: returns false if the message was not sent.
using Writer = std::function<bool(Bytes)>;

// name: "pose" in the namespace of the node's vehicle, "/tf" outside. qos: kLatched or kLatchedLarge, which match all
// readers of ROS 2. Throws std::runtime_error.
template <class Type>
Writer writer(dds::Node& node, const std::string& name, messages::Qos qos = messages::Qos::kLatched);

// The writer of a topic of the type that ROS 2 calls "geometry_msgs/msg/PoseStamped". Throws std::logic_error for a type
// that is not one of the above.
Writer writer_of(dds::Node& node, const std::string& name, const std::string& ros_type);

// A reader of one topic. Throws std::runtime_error.
template <class Type>
class Reader {
 public:
  Reader(dds::Node& node, const std::string& name, messages::Qos qos,
         std::function<void(const Bytes&)> callback);

 private:
  std::unique_ptr<const std::string> name_;  // outlives the subscription
  dds::Subscription subscription_;
};

}  // namespace swiftlet::ros
