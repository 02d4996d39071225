// The generated type supports of all messages.
#pragma once

#include "swiftlet_msgs/msg/ActuatorCommandPubSubTypes.h"
#include "swiftlet_msgs/msg/AttitudeSetpointPubSubTypes.h"
#include "swiftlet_msgs/msg/BatteryPubSubTypes.h"
#include "swiftlet_msgs/msg/ClockReplyPubSubTypes.h"
#include "swiftlet_msgs/msg/ClockRequestPubSubTypes.h"
#include "swiftlet_msgs/msg/ClockStatusPubSubTypes.h"
#include "swiftlet_msgs/msg/CommandAckPubSubTypes.h"
#include "swiftlet_msgs/msg/CommandPubSubTypes.h"
#include "swiftlet_msgs/msg/ControlSettingsPubSubTypes.h"
#include "swiftlet_msgs/msg/ControlStatusPubSubTypes.h"
#include "swiftlet_msgs/msg/ControllerStatePubSubTypes.h"
#include "swiftlet_msgs/msg/EstimatePubSubTypes.h"
#include "swiftlet_msgs/msg/GroundLinkPubSubTypes.h"
#include "swiftlet_msgs/msg/GroundTruthPubSubTypes.h"
#include "swiftlet_msgs/msg/ImuPubSubTypes.h"
#include "swiftlet_msgs/msg/MissionPubSubTypes.h"
#include "swiftlet_msgs/msg/MissionStatusPubSubTypes.h"
#include "swiftlet_msgs/msg/MocapPosePubSubTypes.h"
#include "swiftlet_msgs/msg/RatesSetpointPubSubTypes.h"
#include "swiftlet_msgs/msg/ReferencePubSubTypes.h"
#include "swiftlet_msgs/msg/RotorSpeedsPubSubTypes.h"
#include "swiftlet_msgs/msg/SetpointPubSubTypes.h"
#include "swiftlet_msgs/msg/SimulationClockPubSubTypes.h"
#include "swiftlet_msgs/msg/TrajectoryPubSubTypes.h"
#include "swiftlet_msgs/msg/TrajectorySetpointPubSubTypes.h"
#include "swiftlet_msgs/msg/VehicleInfoPubSubTypes.h"
#include "swiftlet_msgs/msg/VehicleOdometryPubSubTypes.h"

#include "swiftlet/services/messages/topics.hpp"

// All message types of topics.
// clang-format off
#define SWIFTLET_FOR_EACH_MESSAGE(X)                                      \
  X(ActuatorCommand) X(AttitudeSetpoint) X(Battery) X(ClockReply) X(ClockRequest) X(ClockStatus) X(Command) X(CommandAck) X(ControllerState) X(ControlSettings) X(ControlStatus) \
  X(Estimate) X(GroundLink) X(GroundTruth) X(Imu) X(Mission) X(MissionStatus) \
  X(MocapPose) X(RatesSetpoint) X(Reference) X(RotorSpeeds) X(Setpoint)   \
  X(SimulationClock) X(Trajectory) X(TrajectorySetpoint) X(VehicleInfo) X(VehicleOdometry)
// clang-format on

namespace swiftlet::dds {

template <class T>
struct PubSubTypeOf;
#define SWIFTLET_PUB_SUB_TYPE(Name)               \
  template <>                                     \
  struct PubSubTypeOf<messages::msg::Name> {      \
    using type = messages::msg::Name##PubSubType; \
  };
SWIFTLET_FOR_EACH_MESSAGE(SWIFTLET_PUB_SUB_TYPE)
#undef SWIFTLET_PUB_SUB_TYPE

}  // namespace swiftlet::dds
