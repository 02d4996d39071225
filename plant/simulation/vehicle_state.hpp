// Integrated state of the vehicle, and the command to its motors.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::plant {

struct VehicleState {
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();  // m/s
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();  // rad/s
  PerRotor rotor_speeds{};                                   // rad/s, >= 0
  PerRotor armature_currents{};                              // A; integrated only with armature inductance
  double state_of_charge = 1.0;                              // of the battery, 0 empty .. 1 full
  double sag_v = 0.0;                                        // V, open-circuit minus terminal voltage
};

// Command to the ESCs.
struct MotorCommand {
  RotorState state = RotorState::kOff;  // kOff: v_a = 0
  PerRotor throttle{};                  // delta of Eq. (8), 0 .. 1
};

}  // namespace swiftlet::plant
