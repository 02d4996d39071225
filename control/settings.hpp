// What a user sets of the controller: weights, bandwidths, limits, thresholds. The control settings file
// holds the same keys.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "plant/model/vehicle.hpp"

namespace swiftlet::control {

// The model that an attitude axis is designed on: the paper's Eq. (38)-(40), or the same with the rotor lag
// as third state.
enum class AttitudeModel { kDoubleIntegrator, kMotorLag };

// What the attitude's angle errors are: differences of the paper's Euler angles, Eq. (29)-(31), or parts of
// the rotation that is missing, which know no singularity (attitude/attitude_error.hpp).
enum class AttitudeErrorKind { kEulerAngles, kRotation };

// LQR weights of one axis on (angle, rate, moment / inertia): rad^-2, (rad/s)^-2, (rad/s^2)^-2. The third is
// used with kMotorLag only.
struct LqrWeights {
  Eigen::Vector3d q = Eigen::Vector3d::Zero();  // >= 0, q[0] > 0
  double r = 1.0;                               // > 0, on the commanded moment / inertia
};

struct AttitudeSettings {
  AttitudeModel model = AttitudeModel::kMotorLag;
  AttitudeErrorKind error = AttitudeErrorKind::kRotation;
  LqrWeights roll, pitch, yaw;
  bool feed_forward = true;  // rates and accelerations of the reference's attitude, from its jerk and snap
};

// RPT of one axis, Eq. (49) and its integral form.
struct RptSettings {
  double omega_n = 1.0;  // rad/s, > 0
  double zeta = 1.0;     // > 0
  double epsilon = 1.0;  // > 0
  double k_i = 0.0;      // >= 0; 0: no integral
};

struct PositionSettings {
  RptSettings x, y, z;
  double integral_limit = 2.0;  // m/s^2, bound of the integral's part of the acceleration, each axis
};

// The observer of what pushes the vehicle besides its thrust; what it sees is commanded against.
struct DisturbanceSettings {
  double bandwidth = 20.0;  // rad/s; 0: nothing is observed
  double limit = 3.0;       // m/s^2, bound of the length of what it sees
};

// Bounds on what is flown; a request beyond them is refused, a feedback command beyond them is clipped.
struct Limits {
  double max_tilt_rad = 0.6;
  double max_acceleration = 5.0;                       // m/s^2, horizontal and vertical feedback command
  double max_speed = 2.0;                              // m/s, of references that are planned here
  double max_reference_acceleration = 2.0;             // m/s^2, of references that are planned here
  double max_yaw_rate = 1.5;                           // rad/s, of references that are planned here
  Eigen::Vector3d fence_min_ned = {-3.0, -3.0, -2.5};  // m
  Eigen::Vector3d fence_max_ned = {3.0, 3.0, 0.2};     // m
};

// Observer gains: each corrects by the mocap innovation. Bandwidths in rad/s.
struct EstimatorSettings {
  double position_bandwidth = 12.0;       // of the position/velocity/accelerometer-bias observer
  double attitude_bandwidth = 6.0;        // of the attitude/gyro-bias observer
  double accelerometer_bias_limit = 1.0;  // m/s^2
  double gyro_bias_limit = 0.3;           // rad/s
};

// When to give up what. Times in s.
struct FailsafeSettings {
  double mocap_timeout_s = 0.5;      // without a pose: from dead reckoning to level descent
  double descent_speed = 0.4;        // m/s
  double descent_timeout_s = 6.0;    // then rotors off
  double tip_over_tilt_rad = 1.4;    // rotors off
  double low_battery_voltage = 3.3;  // land
  double setpoint_timeout_s = 0.5;   // from setpoint stream to hold
};

struct ControlSettings {
  std::string name;
  AttitudeSettings attitude;
  PositionSettings position;
  DisturbanceSettings disturbance;
  Limits limits;
  EstimatorSettings estimator;
  FailsafeSettings failsafe;
};

// Every rule that the settings break; keys are those of the control settings file ("position.x.omega_n").
std::vector<plant::Violation> validate(const ControlSettings& settings);

}  // namespace swiftlet::control
