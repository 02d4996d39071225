// The commands of a vehicle at each level. All carry the same header, so that command time-out, terms and "rotors
// off" work alike at every level.
#pragma once

#include <variant>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::plant {

struct RatesSetpoint : CommandHeader {
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();  // rad/s
  double thrust_n = 0.0;                                     // collective, along -z of FRD
};

struct AttitudeSetpoint : CommandHeader {
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();  // rad/s, fed forward to the attitude law's
  double thrust_n = 0.0;                                     // collective, along -z of FRD
};

struct TrajectorySetpoint : CommandHeader {
  bool position_used = false;  // false: position_ned is not controlled, velocity and acceleration are
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();      // m
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();      // m/s
  Eigen::Vector3d acceleration_ned = Eigen::Vector3d::Zero();  // m/s^2, fed forward
  double yaw_rad = 0.0;
  double yaw_rate = 0.0;  // rad/s, fed forward
};

// The index is the ControlLevel.
using VehicleCommand = std::variant<ActuatorCommand, RatesSetpoint, AttitudeSetpoint, TrajectorySetpoint>;

inline ControlLevel level_of(const VehicleCommand& command) {
  return static_cast<ControlLevel>(command.index());
}
inline const CommandHeader& header_of(const VehicleCommand& command) {
  return std::visit([](const auto& one) -> const CommandHeader& { return one; }, command);
}
inline CommandHeader& header_of(VehicleCommand& command) {
  return std::visit([](auto& one) -> CommandHeader& { return one; }, command);
}

// The command of this level that turns the rotors off.
inline VehicleCommand rotors_off(ControlLevel level, const CommandHeader& header, int rotor_count) {
  VehicleCommand command;
  if (level == ControlLevel::kRates) command = RatesSetpoint();
  if (level == ControlLevel::kAttitude) command = AttitudeSetpoint();
  if (level == ControlLevel::kTrajectory) command = TrajectorySetpoint();
  if (auto* actuators = std::get_if<ActuatorCommand>(&command)) actuators->rotor_count = rotor_count;
  header_of(command) = header;
  header_of(command).rotor_state = RotorState::kOff;
  return command;
}

}  // namespace swiftlet::plant
