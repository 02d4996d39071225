// Gains of the simulated flight-control firmware, as a manufacturer tunes them for one vehicle.
#pragma once

#include <Eigen/Core>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant {

// PID of the body rates; the output is an angular acceleration. The derivative acts on the measured rate alone.
struct RateGains {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  // 1/s
  Eigen::Vector3d i = Eigen::Vector3d::Zero();  // 1/s^2
  Eigen::Vector3d d = Eigen::Vector3d::Zero();  // 1
  double derivative_cutoff = 300.0;             // rad/s, low-pass of the derivative
  double integral_limit = 10.0;                 // rad/s^2, of each axis
};

struct AttitudeGains {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  // 1/s, rotation error to body rate
  double max_rate = 10.0;                       // rad/s, of each axis
};

// P of the position, PI of the velocity; the output is an acceleration.
struct PositionGains {
  double position_p = 2.0;          // 1/s
  double velocity_p = 4.0;          // 1/s
  double velocity_i = 2.0;          // 1/s^2
  double integral_limit = 3.0;      // m/s^2, of each axis
  double max_correction_m_s = 2.0;  // limit of the velocity that the position error adds
  double max_acceleration = 6.0;    // m/s^2, of each axis
  double max_tilt_rad = 0.7;
};

struct FirmwareGains {
  RateGains rates;
  AttitudeGains attitude;
  PositionGains position;
};

// Each loop as fast as the one inside it allows: the rate loop is limited by the lag of the motors.
FirmwareGains firmware_gains(const Vehicle& vehicle);

}  // namespace swiftlet::plant
