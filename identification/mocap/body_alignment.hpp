// How the body of a motion capture sits on its vehicle, from any motion that IMU and motion capture both record, such as a
// hover. Least squares over the whole recording: poses and IMU readings are weighted with their noise, the motion and the sought
// parameters are unknown together. Errors of attitude as in J. Sola, "Quaternion kinematics for the error-state Kalman filter"
// (arXiv:1711.02508), ch. 5.
//
// With vehicle attitude R, position p of the centre of mass, velocity v, IMU readings f and w, and pose (p_m, R_m):
//   dp/dt = v     dv/dt = R (f - b_f) + g     dR/dt = R [w - b_w]x
//   R_m = R(t - d) M^T     p_m = p(t - d) - R(t - d) l
// l is the lever arm and M the rotation of the misalignment, both as in a room file; d is the delay of the stamps, g gravity in
// the axes of the motion capture, whose vertical may be off.
//
// What a motion tells: M about forward and right from the direction of gravity, as well as the bias of the accelerometer and the
// vertical are known, and better once the vehicle turns about down; M about down from tilting; l across an axis from turning
// about that axis.
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "swiftlet/identification/flight_log.hpp"

namespace swiftlet::identification {

// Standard deviations of what is unknown before, of each component.
struct AlignmentPriors {
  double accelerometer_bias_m_s2 = 0.1;
  double gyro_bias_rad_s = 0.05;
  double vertical_rad = 3e-3;  // of the motion capture's vertical
  double misalignment_rad = 0.2;
  double lever_arm_m = 0.3;
  double pose_delay_s = 0.01;
};

struct EstimatedVector {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Vector3d deviation = Eigen::Vector3d::Zero();  // standard deviation of each component
};

struct BodyAlignment {
  EstimatedVector
      misalignment;  // rotation vector that turns the axes of the poses into those of the vehicle, rad
  EstimatedVector lever_arm;  // from the position of the poses to the centre of mass, FRD, m
  Eigen::Vector2d vertical = Eigen::Vector2d::Zero();  // north and east part of the unit vector down
  Eigen::Vector2d vertical_deviation = Eigen::Vector2d::Zero();
  double pose_delay_s = 0.0;
  double pose_delay_deviation_s = 0.0;
  double force_noise = 0.0;       // density, as found in the recording, m/s^2/sqrt(Hz)
  double rate_noise = 0.0;        // rad/s/sqrt(Hz)
  double position_noise_m = 0.0;  // of a pose, each axis, as found in the recording
  double orientation_noise_rad = 0.0;
  double duration_s = 0.0;
  std::size_t poses = 0;
  std::size_t refused = 0;  // poses far from what IMU and other poses say
};

constexpr double kShortestAlignment_s = 5.0;

// Uses times, specific forces, body rates and poses of the log; the IMU is at the centre of mass. If the
// poses show that the vehicle took off or landed, only what is in the air is used. Throws std::runtime_error
// with a sentence if the recording is too short, or IMU and poses do not show one motion.
BodyAlignment align_body(const FlightLog& log, const AlignmentPriors& priors);

}  // namespace swiftlet::identification
