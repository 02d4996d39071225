// The message types of the fuzzer, each with the letter that selects it.
#pragma once

#include "swiftlet_msgs/msg/ActuatorCommandPubSubTypes.h"
#include "swiftlet_msgs/msg/AttitudeSetpointPubSubTypes.h"
#include "swiftlet_msgs/msg/BatteryPubSubTypes.h"
#include "swiftlet_msgs/msg/CommandPubSubTypes.h"
#include "swiftlet_msgs/msg/ControlSettingsPubSubTypes.h"
#include "swiftlet_msgs/msg/ControllerStatePubSubTypes.h"
#include "swiftlet_msgs/msg/GroundLinkPubSubTypes.h"
#include "swiftlet_msgs/msg/GroundTruthPubSubTypes.h"
#include "swiftlet_msgs/msg/ImuPubSubTypes.h"
#include "swiftlet_msgs/msg/MissionPubSubTypes.h"
#include "swiftlet_msgs/msg/MocapPosePubSubTypes.h"
#include "swiftlet_msgs/msg/RatesSetpointPubSubTypes.h"
#include "swiftlet_msgs/msg/RotorSpeedsPubSubTypes.h"
#include "swiftlet_msgs/msg/SetpointPubSubTypes.h"
#include "swiftlet_msgs/msg/TrajectoryPubSubTypes.h"
#include "swiftlet_msgs/msg/TrajectorySetpointPubSubTypes.h"
#include "swiftlet_msgs/msg/VehicleOdometryPubSubTypes.h"

#include "swiftlet/services/messages/convert.hpp"
#include "tests/support/serialization.hpp"

namespace swiftlet::tests {

template <char kTagValue, class PubSubType, class PlainStruct>
struct MessageType {
  static constexpr char kTag = kTagValue;
  using PubSub = PubSubType;
  using Plain = PlainStruct;
};

using Imu = MessageType<'i', messages::msg::ImuPubSubType, plant::ImuSample>;
using VehicleOdometry = MessageType<'o', messages::msg::VehicleOdometryPubSubType, plant::OdometrySample>;
using MocapPose = MessageType<'p', messages::msg::MocapPosePubSubType, plant::PoseSample>;
using Battery = MessageType<'b', messages::msg::BatteryPubSubType, plant::BatterySample>;
using RotorSpeeds = MessageType<'r', messages::msg::RotorSpeedsPubSubType, plant::RotorSpeedSample>;
using ActuatorCommand = MessageType<'a', messages::msg::ActuatorCommandPubSubType, plant::ActuatorCommand>;
using RatesSetpoint = MessageType<'w', messages::msg::RatesSetpointPubSubType, plant::RatesSetpoint>;
using AttitudeSetpoint = MessageType<'h', messages::msg::AttitudeSetpointPubSubType, plant::AttitudeSetpoint>;
using TrajectorySetpoint =
    MessageType<'y', messages::msg::TrajectorySetpointPubSubType, plant::TrajectorySetpoint>;
using GroundTruth = MessageType<'g', messages::msg::GroundTruthPubSubType, plant::TruthSample>;
using Setpoint = MessageType<'s', messages::msg::SetpointPubSubType, control::Setpoint>;
using ControllerState =
    MessageType<'c', messages::msg::ControllerStatePubSubType, messages::ControllerReport>;
using GroundLink = MessageType<'l', messages::msg::GroundLinkPubSubType, control::GroundHeartbeat>;
using Command = MessageType<'q', messages::msg::CommandPubSubType, control::Request>;
using Mission = MessageType<'m', messages::msg::MissionPubSubType, control::Mission>;
using ControlSettings = MessageType<'n', messages::msg::ControlSettingsPubSubType, control::SettingsRequest>;
using Trajectory = MessageType<'t', messages::msg::TrajectoryPubSubType, control::Trajectory>;

}  // namespace swiftlet::tests
