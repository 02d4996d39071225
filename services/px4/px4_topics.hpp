// The topics of PX4 1.16 over uXRCE-DDS. Their names, types and layouts are PX4's: idl/px4_msgs has them as they lie on the
// wire. PX4's writers and readers are best effort.
#pragma once

#include <string>

#include "px4_msgs/msg/BatteryStatus.h"
#include "px4_msgs/msg/FailsafeFlags.h"
#include "px4_msgs/msg/OffboardControlMode.h"
#include "px4_msgs/msg/SensorCombined.h"
#include "px4_msgs/msg/TrajectorySetpoint.h"
#include "px4_msgs/msg/VehicleAttitudeSetpoint.h"
#include "px4_msgs/msg/VehicleCommand.h"
#include "px4_msgs/msg/VehicleCommandAck.h"
#include "px4_msgs/msg/VehicleLandDetected.h"
#include "px4_msgs/msg/VehicleOdometry.h"
#include "px4_msgs/msg/VehicleRatesSetpoint.h"
#include "px4_msgs/msg/VehicleStatus.h"

#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::px4 {

namespace msg = px4_msgs::msg;

// As PX4's simulation names them, the folder of the first instance, 0, is "/fmu", that of instance N "/px4_N/fmu". On a vehicle,
// UXRCE_DDS_NS_IDX makes "/uav_N/fmu" of each: the prefix is then "uav_".
std::string topic_folder(int instance, const std::string& prefix = "");

// A topic of PX4 whose name this object keeps. The name begins with "/": it is outside the namespace of a vehicle.
template <class T>
class Px4Topic {
 public:
  Px4Topic(const std::string& folder, const std::string& name) : name_(folder + name) {}
  messages::Topic<T> get() const { return {name_.c_str(), messages::Qos::kTelemetry}; }
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

struct Px4Topics {
  Px4Topics(int instance, const std::string& prefix) : folder(topic_folder(instance, prefix)) {}

  std::string folder;
  // Topics that PX4 reads.
  Px4Topic<msg::OffboardControlMode> offboard_control_mode{folder, "/in/offboard_control_mode"};
  Px4Topic<msg::TrajectorySetpoint> trajectory_setpoint{folder, "/in/trajectory_setpoint"};
  Px4Topic<msg::VehicleAttitudeSetpoint> attitude_setpoint{folder, "/in/vehicle_attitude_setpoint"};
  Px4Topic<msg::VehicleRatesSetpoint> rates_setpoint{folder, "/in/vehicle_rates_setpoint"};
  Px4Topic<msg::VehicleOdometry> visual_odometry{folder, "/in/vehicle_visual_odometry"};
  Px4Topic<msg::VehicleCommand> command{folder, "/in/vehicle_command"};
  // Topics that PX4 publishes.
  Px4Topic<msg::SensorCombined> sensors{folder, "/out/sensor_combined"};
  Px4Topic<msg::VehicleOdometry> odometry{folder, "/out/vehicle_odometry"};
  Px4Topic<msg::BatteryStatus> battery{folder, "/out/battery_status"};
  Px4Topic<msg::VehicleStatus> status{folder, "/out/vehicle_status_v1"};
  Px4Topic<msg::VehicleLandDetected> land_detected{folder, "/out/vehicle_land_detected"};
  Px4Topic<msg::FailsafeFlags> failsafe_flags{folder, "/out/failsafe_flags"};
  Px4Topic<msg::VehicleCommandAck> command_ack{folder, "/out/vehicle_command_ack"};
};

}  // namespace swiftlet::px4
