// What programs of ROS 2 ask of a vehicle: messages of ROS 2 in NED.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/ground/ros/ros_messages.hpp"

namespace swiftlet::ros {

struct Goal {
  Eigen::Vector3d position_ned_m = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;  // from north towards east
};

// geometry_msgs/PoseStamped in the frame map (ENU) or in no frame. A height of exactly 0, which the 2-D goals of rviz have,
// stands for present_down_m. Returns nothing, and a sentence in `refusal`, if the message is not such a pose.
std::optional<Goal> goal_of(const Bytes& payload, double present_down_m, std::string& refusal);

// geometry_msgs/Twist in the vehicle's frame (FLU), turned by its heading: a velocity in NED and a yaw rate. Roll and pitch
// rate must be 0. Returns nothing, and a sentence in `refusal`, if the message is not such a twist.
std::optional<ground::VelocitySetpoint> velocity_of(const Bytes& payload, double yaw_rad,
                                                    std::string& refusal);

}  // namespace swiftlet::ros
