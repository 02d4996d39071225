// The six loops of a vehicle that closes its inner loops itself and is commanded at level rates, attitude or trajectory
// (docs/vehicle.md), as FlownLoop: with the rotor lag, the observers of the estimator, and the delay from a sample to the
// vehicle that obeys the command. At level trajectory no delay is in a loop.
//
// - The vehicle's loops are those of a usual firmware: PID of the body rates with the derivative of the measured rate
//   behind a low-pass, P of the attitude, P of the position over PI of the velocity.
// - The delay is a Pade approximation of third order, as in flown_loops.hpp. It acts on rates or attitude, and on thrust.
#pragma once

#include <array>

#include <Eigen/Core>

#include "swiftlet/control/design/flown_loops.hpp"
#include "swiftlet/plant/model/control_level.hpp"

namespace swiftlet::control {

// Gains of the vehicle's own loops; of angles in the order roll, pitch, yaw.
struct VehicleLoops {
  Eigen::Vector3d rate_p = Eigen::Vector3d::Zero();      // 1/s, rate error to angular acceleration
  Eigen::Vector3d rate_i = Eigen::Vector3d::Zero();      // 1/s^2, > 0
  Eigen::Vector3d rate_d = Eigen::Vector3d::Zero();      // 1
  double derivative_cutoff = 0.0;                        // rad/s, > 0
  Eigen::Vector3d attitude_p = Eigen::Vector3d::Zero();  // 1/s, rotation error to body rate
  double position_p = 0.0;                               // 1/s
  double velocity_p = 0.0;                               // 1/s
  double velocity_i = 0.0;                               // 1/s^2
};

// True if control closes the loop of kFlownLoopNames[i], false if the vehicle does.
bool closed_by_control(plant::ControlLevel level, std::size_t i);

// In the order of kFlownLoopNames. level: not actuators. Those of the attitude are cut at the rate command, those of the
// position at the acceleration command. delay_s >= 0.
std::array<FlownLoop, 6> level_loops(plant::ControlLevel level, const ControlGains& gains,
                                     const ObservedRotors& rotors, const VehicleLoops& vehicle,
                                     double delay_s);

// Rotation error to body rate of control's attitude law, k_angle / k_rate, 1/s: at level rates.
Eigen::Vector3d rate_per_angle(const ControlGains& gains);

}  // namespace swiftlet::control
