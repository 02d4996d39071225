// What a user sets of the controller: weights, bandwidths, limits, thresholds. The control settings file
// holds the same keys.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/plant/model/vehicle.hpp"

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
  double max_reference_jerk = 8.0;                     // m/s^3, of references that are planned here
  double max_yaw_rate = 1.5;                           // rad/s, of references that are planned here
  double max_body_rate = 6.0;                          // rad/s, of setpoints of body rates
  Eigen::Vector3d fence_min_ned = {-3.0, -3.0, -2.5};  // m
  Eigen::Vector3d fence_max_ned = {3.0, 3.0, 0.2};     // m
};

// What the estimator believes of its sensors. Noise densities as on data sheets; standard deviations are each
// axis's.
struct EstimatorSettings {
  double accelerometer_noise_density = 4.0e-3;  // m/s^2/sqrt(Hz)
  double gyro_noise_density = 2.0e-4;           // rad/s/sqrt(Hz)
  double accelerometer_bias_walk = 2.0e-2;      // m/s^2/sqrt(s), with what a misaligned marker body adds
  double gyro_bias_walk = 1.0e-4;               // rad/s/sqrt(s)
  double accelerometer_bias_sigma = 0.2;        // m/s^2, before the first pose
  double gyro_bias_sigma = 0.02;                // rad/s, likewise
  double accelerometer_bias_limit = 1.0;        // m/s^2
  double gyro_bias_limit = 0.3;                 // rad/s
  double mocap_position_sigma = 5.0e-5;         // m
  double mocap_orientation_sigma = 7.0e-4;      // rad
  // Bound on the squared normalised innovation, chi-square of 6 degrees of freedom: one good pose in 26,000
  // is beyond 30.
  double gate_chi_square = 30.0;
  double outlier_position_m = 0.05;      // beyond the bound and this far off: refused
  double outlier_orientation_rad = 0.1;  // likewise
  double rotor_speed_bandwidth = 112.0;  // rad/s, at which measured rotor speeds correct the motor model
};

// What a vehicle may show on the ground and still be armed.
struct ArmingSettings {
  double max_tilt_rad = 0.35;
  double max_speed = 0.3;                 // m/s, by the estimate
  double max_body_rate = 0.2;             // rad/s, bias removed
  double max_specific_force_error = 1.0;  // m/s^2, against gravity in the attitude of the pose
  double max_rotor_speed = 100.0;         // rad/s, of any rotor
};

// What the vehicle does when a ground tool falls silent that its flight depends on.
enum class GroundLinkAction : std::uint8_t { kNone, kHold, kLand };

// When to give up what. Times in s.
struct FailsafeSettings {
  double imu_timeout_s = 0.1;             // of samples that cannot be used, in a row: rotors off
  double imu_gap_s = 0.3;                 // between two samples: rotors off
  double tip_over_tilt_rad = 1.4;         // rotors off
  double blow = 100.0;                    // m/s^2, of the specific force: rotors off
  double mocap_timeout_s = 0.5;           // without a pose: from dead reckoning to level descent
  double descent_speed = 0.4;             // m/s, without position, and of landings at most
  double descent_timeout_s = 6.0;         // without position: rotors off
  double low_battery_voltage = 3.3;       // land
  double critical_battery_voltage = 3.1;  // land faster
  double battery_delay_s = 1.0;           // the voltage has been below these for so long
  double battery_timeout_s = 2.0;         // without a battery sample: land
  double critical_descent_speed = 0.8;    // m/s
  double fence_margin_m = 0.2;            // this far outside the fence: land, inside it
  double setpoint_timeout_s = 0.75;    // from setpoint stream to hold; a stream of 2 Hz may be late by half
  double ground_link_timeout_s = 1.0;  // without a sign of life
  GroundLinkAction ground_link_action = GroundLinkAction::kLand;
};

struct ControlSettings {
  std::string name;
  AttitudeSettings attitude;
  PositionSettings position;
  DisturbanceSettings disturbance;
  Limits limits;
  EstimatorSettings estimator;
  ArmingSettings arming;
  FailsafeSettings failsafe;
};

// Every rule that the settings break; keys are those of the control settings file ("position.x.omega_n").
std::vector<plant::Violation> validate(const ControlSettings& settings);

}  // namespace swiftlet::control
