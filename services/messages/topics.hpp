// The topics of a vehicle: name, type and QoS profile of each, as in idl/README.md. The wire name is
// rt/<vehicle>/<name>.
#pragma once

#include "swiftlet_msgs/msg/ActuatorCommand.h"
#include "swiftlet_msgs/msg/AttitudeSetpoint.h"
#include "swiftlet_msgs/msg/Battery.h"
#include "swiftlet_msgs/msg/ClockReply.h"
#include "swiftlet_msgs/msg/ClockRequest.h"
#include "swiftlet_msgs/msg/ClockStatus.h"
#include "swiftlet_msgs/msg/Command.h"
#include "swiftlet_msgs/msg/CommandAck.h"
#include "swiftlet_msgs/msg/ControlSettings.h"
#include "swiftlet_msgs/msg/ControlStatus.h"
#include "swiftlet_msgs/msg/ControllerState.h"
#include "swiftlet_msgs/msg/Estimate.h"
#include "swiftlet_msgs/msg/GroundLink.h"
#include "swiftlet_msgs/msg/GroundTruth.h"
#include "swiftlet_msgs/msg/Imu.h"
#include "swiftlet_msgs/msg/Mission.h"
#include "swiftlet_msgs/msg/MissionStatus.h"
#include "swiftlet_msgs/msg/MocapPose.h"
#include "swiftlet_msgs/msg/RatesSetpoint.h"
#include "swiftlet_msgs/msg/Reference.h"
#include "swiftlet_msgs/msg/RotorSpeeds.h"
#include "swiftlet_msgs/msg/Setpoint.h"
#include "swiftlet_msgs/msg/SimulationClock.h"
#include "swiftlet_msgs/msg/Trajectory.h"
#include "swiftlet_msgs/msg/TrajectorySetpoint.h"
#include "swiftlet_msgs/msg/VehicleInfo.h"
#include "swiftlet_msgs/msg/VehicleOdometry.h"

#include "swiftlet/services/messages/qos.hpp"

namespace swiftlet::messages {

namespace msg = swiftlet_msgs::msg;

template <class T>
struct Topic {
  using Message = T;
  const char* name;
  Qos qos;
};

namespace topics {
inline constexpr Topic<msg::Imu> kImu{"imu", Qos::kStream};
inline constexpr Topic<msg::VehicleOdometry> kVehicleOdometry{"vehicle_odometry", Qos::kStream};
inline constexpr Topic<msg::ActuatorCommand> kActuatorCommand{"actuator_command", Qos::kStream};
inline constexpr Topic<msg::RatesSetpoint> kRatesSetpoint{"rates_setpoint", Qos::kStream};
inline constexpr Topic<msg::AttitudeSetpoint> kAttitudeSetpoint{"attitude_setpoint", Qos::kStream};
inline constexpr Topic<msg::TrajectorySetpoint> kTrajectorySetpoint{"trajectory_setpoint", Qos::kStream};
inline constexpr Topic<msg::ControllerState> kControllerState{"controller_state", Qos::kStream};
inline constexpr Topic<msg::MocapPose> kMocapPose{"mocap_pose", Qos::kStream};
inline constexpr Topic<msg::RotorSpeeds> kRotorSpeeds{"rotor_speeds", Qos::kStream};
inline constexpr Topic<msg::Setpoint> kSetpoint{"setpoint", Qos::kStream};
inline constexpr Topic<msg::ClockRequest> kClockRequest{"clock_request", Qos::kStream};
inline constexpr Topic<msg::ClockReply> kClockReply{"clock_reply", Qos::kStream};
inline constexpr Topic<msg::Battery> kBattery{"battery", Qos::kTelemetry};
inline constexpr Topic<msg::Estimate> kEstimate{"estimate", Qos::kTelemetry};
inline constexpr Topic<msg::Reference> kReference{"reference", Qos::kTelemetry};
inline constexpr Topic<msg::GroundTruth> kGroundTruth{"ground_truth", Qos::kTelemetry};
inline constexpr Topic<msg::ClockStatus> kClockStatus{"clock_status", Qos::kTelemetry};
inline constexpr Topic<msg::ControlStatus> kControlStatus{"control_status", Qos::kLatched};
inline constexpr Topic<msg::MissionStatus> kMissionStatus{"mission_status", Qos::kLatched};
inline constexpr Topic<msg::VehicleInfo> kVehicleInfo{"vehicle_info", Qos::kLatched};
inline constexpr Topic<msg::GroundLink> kGroundLink{"ground_link", Qos::kTelemetry};
inline constexpr Topic<msg::SimulationClock> kSimulationClock{"simulation_clock", Qos::kLatched};
inline constexpr Topic<msg::Command> kCommand{"command", Qos::kRequest};
inline constexpr Topic<msg::Mission> kMission{"mission", Qos::kRequest};
inline constexpr Topic<msg::Trajectory> kTrajectory{"trajectory", Qos::kRequest};
inline constexpr Topic<msg::ControlSettings> kControlSettings{"control_settings", Qos::kRequest};
inline constexpr Topic<msg::Mission> kFlownMission{"flown_mission", Qos::kLatchedLarge};
inline constexpr Topic<msg::Trajectory> kFlownTrajectory{"flown_trajectory", Qos::kLatchedLarge};
inline constexpr Topic<msg::CommandAck> kCommandAck{"command_ack", Qos::kReply};
}  // namespace topics

}  // namespace swiftlet::messages
