// What the vehicle's messages say, as standard types of ROS 2, which 3-D panels and plots know: in ENU (map) and FLU
// (the vehicle's frame).
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/record/file/event_log.hpp"
#include "swiftlet/record/file/standard_message.hpp"
#include "swiftlet/record/mcap/records.hpp"
#include "swiftlet/services/messages/schemas.hpp"
#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::record {

constexpr const char* kMapFrame = "map";  // ENU, at the origin of NED

Eigen::Vector3d enu_from_ned(const Eigen::Vector3d& v_ned);
Eigen::Vector3d flu_from_frd(const Eigen::Vector3d& v_frd);
Eigen::Quaterniond q_enu_from_flu(const Eigen::Quaterniond& q_ned_from_frd);

// The messages of one vehicle:
//   estimate   -> pose (geometry_msgs/PoseStamped), /tf (tf2_msgs/TFMessage: map to the vehicle's name), odometry
//                 (nav_msgs/Odometry), and each second path (nav_msgs/Path: its last half minute)
//   reference  -> reference_pose (geometry_msgs/PoseStamped)
//   imu        -> imu_flu (sensor_msgs/Imu)
//   battery    -> battery_state (sensor_msgs/BatteryState)
//   control_status, mission_status, command_ack, vehicle_info -> log (foxglove Log), see event_log.hpp
class StandardMessages {
 public:
  explicit StandardMessages(std::string vehicle);

  std::vector<StandardTopic> topics() const;
  std::vector<StandardTopic> ros_topics() const;  // without the log, which is no type of ROS 2

  // The messages that follow from one of the vehicle's, at its log time. topic: "estimate", "imu" ...
  std::vector<StandardMessage> of(const std::string& topic, const mcap::Message& message);

 private:
  struct Pose {
    std::int64_t time_ns = 0;
    Eigen::Vector3d position_enu = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_enu_from_flu = Eigen::Quaterniond::Identity();
  };
  std::vector<StandardMessage> of_estimate(const mcap::Message& message);
  std::vector<StandardMessage> of_reference(const mcap::Message& message) const;
  std::vector<StandardMessage> of_imu(const mcap::Message& message) const;
  std::vector<StandardMessage> of_battery(const mcap::Message& message) const;
  std::string topic_of(const char* name) const { return "/" + vehicle_ + "/" + name; }
  StandardMessage named(const char* name, const messages::MessageSchema& schema, mcap::Bytes payload) const;
  StandardMessage pose_message(const char* name, const Pose& pose) const;
  StandardMessage transform_message(const Pose& pose) const;
  StandardMessage odometry_message(const Pose& pose, const messages::msg::Estimate& estimate) const;
  StandardMessage path_message(std::int64_t time_ns) const;
  std::string vehicle_;
  EventLog events_;
  std::deque<Pose> path_;
  std::int64_t path_sent_ns_ = 0;
};

}  // namespace swiftlet::record
