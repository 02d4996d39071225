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
  double omega_n = 1.0;        // rad/s, > 0
  double zeta = 1.0;           // > 0
  double epsilon = 1.0;        // > 0
  double integral_pole = 0.0;  // >= 0; 0: no integral
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

// The thresholds of the estimator's detectors (control/estimation/README.md: symptom, detector, consequence). The
// defaults serve any vehicle of this size; what depends on the vehicle is max_speed and max_body_rate.

// Poses that repeat (pose_stream.hpp). Distances: m of the position, and of each part of the quaternion.
struct StuckPoseSettings {
  double same = 1.0e-8;      // poses closer than that repeat
  double distinct = 2.0e-6;  // poses further apart show noise, ...
  int distinct_poses = 20;   // ... if so many do in a row, with the rotors off
  int repetitions = 5;  // in a row: a stream that has noise is frozen; a single one is a frame sent twice
};

// Poses that go on as those of one body (pose_stream.hpp).
struct PoseContinuitySettings {
  double noise_m = 0.01;       // that may add to a way between two poses
  double noise_rad = 0.01;     // likewise, to a turn
  double longest_gap_s = 0.1;  // between two poses, that hides no step there and back
  int lasting_poses = 8;       // with the rotors off a stream is believed that goes on for so many poses ...
  double lasting_s = 0.2;      // ... and for so long
};

// IMU samples that are missing (estimator.hpp): what may have happened meanwhile is added to the covariance.
struct ImuSilenceSettings {
  double from_s = 0.02;       // between two samples: a silence
  double longest_s = 0.25;    // longer ones are not integrated over
  double acceleration = 2.0;  // m/s^2, that it may hide
  double body_rate = 0.5;     // rad/s, that it may hide
  double turn_rad = 0.025;    // of a pose against the estimate, that needs no trial ...
  double turn_sigmas = 4.0;   // ... nor do so many standard deviations of the orientation
};

// Poses that move otherwise than the IMU feels, after a silence (pose_imu_consistency.hpp).
struct PoseImuConsistencySettings {
  double interval_s = 0.06;   // two of them make a verdict
  double acceleration = 0.3;  // m/s^2, that poses and IMU may differ by: a tilt of 1.8 degrees
  double turn_rad = 0.015;    // likewise, of their turns
  double sigmas = 3.0;        // of the poses' noise, on top of both
};

// A climb that the accelerometer feels and the poses do not show (takeoff_consistency.hpp).
struct TakeoffConsistencySettings {
  double memory_s = 0.7;          // of the high pass: a bias below inertial_climb_m / memory_s^2 is no climb
  double inertial_climb_m = 0.1;  // that count as a climb
  double min_pose_fraction = 0.333;  // of the felt height: fewer contradict
  double confirmed_climb_m = 0.3;    // of climb in the estimate: the watch is over
  double longest_s = 4.0;            // likewise
};

// Poses that contradict the estimate, and when it starts anew from them (estimator.hpp).
struct RecoverySettings {
  double max_lead_s = 0.02;         // of a pose ahead of the IMU
  int glitch_poses = 2;             // contradictions in a row that move the estimate no faster than noise
  double step_time_s = 0.05;        // within which what comes after a glitch may have happened
  double sudden = 2.0;              // times outlier_position_m: a jump, whatever the IMU misleads to
  double swap_rad = 0.35;           // against the estimate: markers taken for each other, another vehicle
  int poses = 5;                    // that disagree, of a stream without a break: the IMU misled
  double speed = 0.3;               // m/s, standard deviation after a restart
  double gyro_bias = 0.1;           // rad/s, likewise
  double accelerometer_bias = 0.5;  // m/s^2, likewise
};

struct DetectorSettings {
  StuckPoseSettings stuck_pose;
  PoseContinuitySettings continuity;
  ImuSilenceSettings imu_silence;
  PoseImuConsistencySettings pose_imu_consistency;
  TakeoffConsistencySettings takeoff_consistency;
  RecoverySettings recovery;
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
  // The fastest that the vehicle plausibly moves, carried or thrown as well: poses that lie farther apart have
  // stepped. A gyro that misleads is off by half of max_body_rate at most.
  double max_speed = 4.0;                // m/s
  double max_body_rate = 6.0;            // rad/s
  double start_speed = 1.0;              // m/s, standard deviation at the first pose
  double rotor_speed_bandwidth = 112.0;  // rad/s, at which measured rotor speeds correct the motor model
  DetectorSettings detectors;
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
