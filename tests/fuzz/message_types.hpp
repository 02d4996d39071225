// The message types of the fuzzer, each with the letter that selects it.
#pragma once

#include <tuple>
#include <type_traits>

#include "swiftlet/services/messages/convert.hpp"

namespace swiftlet::tests {

template <char kTagValue, class MessageStruct, class PlainStruct>
struct MessageType {
  static constexpr char kTag = kTagValue;
  using Message = MessageStruct;
  using Plain = PlainStruct;
};

using MessageTypes =
    std::tuple<MessageType<'i', messages::msg::Imu, plant::ImuSample>,
               MessageType<'o', messages::msg::VehicleOdometry, plant::OdometrySample>,
               MessageType<'p', messages::msg::MocapPose, plant::PoseSample>,
               MessageType<'b', messages::msg::Battery, plant::BatterySample>,
               MessageType<'r', messages::msg::RotorSpeeds, plant::RotorSpeedSample>,
               MessageType<'a', messages::msg::ActuatorCommand, plant::ActuatorCommand>,
               MessageType<'w', messages::msg::RatesSetpoint, plant::RatesSetpoint>,
               MessageType<'h', messages::msg::AttitudeSetpoint, plant::AttitudeSetpoint>,
               MessageType<'y', messages::msg::TrajectorySetpoint, plant::TrajectorySetpoint>,
               MessageType<'g', messages::msg::GroundTruth, plant::TruthSample>,
               MessageType<'s', messages::msg::Setpoint, control::Setpoint>,
               MessageType<'c', messages::msg::ControllerState, messages::ControllerReport>,
               MessageType<'l', messages::msg::GroundLink, control::GroundHeartbeat>,
               MessageType<'q', messages::msg::Command, control::Request>,
               MessageType<'m', messages::msg::Mission, control::Mission>,
               MessageType<'n', messages::msg::ControlSettings, control::SettingsRequest>,
               MessageType<'t', messages::msg::Trajectory, control::Trajectory>>;

// 0 for a type that no process converts, and so none fuzzes.
template <class Message, class... Types>
constexpr char tag_of(std::tuple<Types...>) {
  return static_cast<char>(((std::is_same_v<Message, typename Types::Message> ? Types::kTag : 0) + ...));
}

}  // namespace swiftlet::tests
