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

using Imu = MessageType<'i', comms::msg::ImuPubSubType, plant::ImuSample>;
using VehicleOdometry = MessageType<'o', comms::msg::VehicleOdometryPubSubType, plant::OdometrySample>;
using MocapPose = MessageType<'p', comms::msg::MocapPosePubSubType, plant::PoseSample>;
using Battery = MessageType<'b', comms::msg::BatteryPubSubType, plant::BatterySample>;
using RotorSpeeds = MessageType<'r', comms::msg::RotorSpeedsPubSubType, plant::RotorSpeedSample>;
using ActuatorCommand = MessageType<'a', comms::msg::ActuatorCommandPubSubType, plant::ActuatorCommand>;
using RatesSetpoint = MessageType<'w', comms::msg::RatesSetpointPubSubType, plant::RatesSetpoint>;
using AttitudeSetpoint = MessageType<'h', comms::msg::AttitudeSetpointPubSubType, plant::AttitudeSetpoint>;
using TrajectorySetpoint =
    MessageType<'y', comms::msg::TrajectorySetpointPubSubType, plant::TrajectorySetpoint>;
using GroundTruth = MessageType<'g', comms::msg::GroundTruthPubSubType, plant::TruthSample>;
using Setpoint = MessageType<'s', comms::msg::SetpointPubSubType, control::Setpoint>;
using ControllerState = MessageType<'c', comms::msg::ControllerStatePubSubType, comms::ControllerReport>;
using GroundLink = MessageType<'l', comms::msg::GroundLinkPubSubType, control::GroundHeartbeat>;
using Command = MessageType<'q', comms::msg::CommandPubSubType, control::Request>;
using Mission = MessageType<'m', comms::msg::MissionPubSubType, control::Mission>;
using ControlSettings = MessageType<'n', comms::msg::ControlSettingsPubSubType, control::SettingsRequest>;
using Trajectory = MessageType<'t', comms::msg::TrajectoryPubSubType, control::Trajectory>;

}  // namespace swiftlet::tests
