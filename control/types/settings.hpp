// The settings of the controller: weights, bandwidths, limits, thresholds. settings_visit.hpp has their keys in the control
// settings file and their limits.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

// The model of an attitude axis for the LQR design: the paper's Eq. (38)-(40), or the same with the rotor
// lag as third state.
enum class AttitudeModel { kDoubleIntegrator, kMotorLag };

// The attitude error: differences of the paper's Euler angles, Eq. (29)-(31), or the parts of the rotation
// between present and desired attitude, which have no singularity (attitude/attitude_error.hpp).
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
  bool feed_forward = true;  // body rates and accelerations from the reference's jerk and snap
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
  double integral_limit = 2.0;  // m/s^2, limit of the integral term on each axis
};

// The disturbance observer. The position loop compensates the acceleration that it estimates.
struct DisturbanceSettings {
  double bandwidth = 20.0;  // rad/s; 0: off
  double limit = 3.0;       // m/s^2, limit of the estimate's length
};

// How the estimated disturbance is compensated (docs/rough-air.md).
enum class DisturbanceLaw {
  kObserved,     // as the observer estimates it
  kLead,         // horizontally ahead of it by the lag of the attitude loop
  kIncremental,  // incremental inversion of force and moment (estimation/moment_observer.hpp)
};

struct RoughAirSettings {
  DisturbanceLaw law = DisturbanceLaw::kLead;
  bool learn_lift = true;  // from lift-off on (estimation/lift_observer.hpp)
  // Factor on the difference of commanded and observed thrust, which is added to the command: the thrust follows with the
  // rotors' lag over 1 + thrust_lead. Only where control commands the rotors.
  double thrust_lead = 1.0;
  // Ground effect (plant/model/rotor.hpp); radius 0: not modelled.
  double rotor_radius_m = 0.0;
  double rotor_height_m = 0.02;  // above the ground, of a standing vehicle
};

// Limits of flight. A request beyond them is refused, a feedback command beyond them is clipped.
struct Limits {
  double max_tilt_rad = 0.6;
  double max_acceleration = 5.0;                       // m/s^2, horizontal and vertical feedback command
  double max_speed = 2.0;                              // m/s, of planned references
  double max_reference_acceleration = 2.0;             // m/s^2, of planned references
  double max_reference_jerk = 8.0;                     // m/s^3, of planned references
  double max_yaw_rate = 1.5;                           // rad/s, of planned references
  double max_body_rate = 6.0;                          // rad/s, of body-rate setpoints
  Eigen::Vector3d fence_min_ned = {-3.0, -3.0, -2.5};  // m
  Eigen::Vector3d fence_max_ned = {3.0, 3.0, 0.0};     // m; z: the ground
  double min_height_m = 0.1;  // above the ground, z = 0; take-offs and landings aside
};

// m, NED: the greatest z at which a reference may be, take-offs and landings aside.
inline double lowest_z_ned(const Limits& limits) {
  return std::min(limits.fence_max_ned.z(), -limits.min_height_m);
}

// The thresholds of the estimator's detectors (control/estimation/README.md: symptom, detector,
// consequence). The defaults fit any vehicle of this size. Only max_speed and max_body_rate depend on the
// vehicle.

// Detects poses that repeat (pose_stream.hpp). Distances: m of position, and of each quaternion component.
struct StuckPoseSettings {
  double same = 1.0e-8;      // poses closer than this repeat
  double distinct = 2.0e-6;  // poses further apart than this show noise ...
  int distinct_poses = 20;   // ... if this many in a row do, with the rotors off
  int repetitions = 5;       // in a row: a noisy stream is stuck; a single one is a frame sent twice
};

// Detects poses that move faster than one body (pose_stream.hpp).
struct PoseContinuitySettings {
  double noise_m = 0.01;       // added to the distance that a body can move between two poses
  double noise_rad = 0.01;     // added to the angle that a body can turn between two poses
  double longest_gap_s = 0.1;  // longest gap between two poses in which no step and step back can hide
  int lasting_poses = 8;       // continuous poses after which a stream is trusted, rotors off, ...
  double lasting_s = 0.2;      // ... if they also span this time
};

// Missing IMU samples (estimator.hpp): the motion that a gap may hide is added to the covariance.
struct ImuSilenceSettings {
  double from_s = 0.02;       // s between two samples above which the IMU was silent
  double longest_s = 0.25;    // s, longest time that is integrated over
  double acceleration = 2.0;  // m/s^2, acceleration that a silence may hide
  double body_rate = 0.5;     // rad/s, body rate that a silence may hide
  double turn_rad = 0.025;    // rotation innovation that needs no consistency test ...
  double turn_sigmas = 4.0;   // ... nor does one of this many standard deviations of orientation
};

// Tests after an IMU silence whether poses and IMU show one motion (pose_imu_consistency.hpp).
struct PoseImuConsistencySettings {
  double interval_s = 0.06;   // s between the test's poses; two intervals give a verdict
  double acceleration = 0.3;  // m/s^2, allowed difference between poses and IMU: a tilt of 1.8 degrees
  double turn_rad = 0.015;    // rad, allowed difference of their rotations
  double sigmas = 3.0;        // standard deviations of the pose noise, added to both
};

// Detects a climb in the accelerometer that the poses do not show (takeoff_consistency.hpp).
struct TakeoffConsistencySettings {
  double memory_s = 0.7;             // high-pass time; a bias below inertial_climb_m / memory_s^2 is no climb
  double inertial_climb_m = 0.1;     // m, inertial climb from which the poses are checked
  double min_pose_fraction = 0.333;  // of the inertial climb; poses that show less contradict it
  double confirmed_climb_m = 0.3;    // m of climb in the estimate that end the monitoring
  double longest_s = 4.0;            // s of flight that end the monitoring
};

// Poses that contradict the estimate, and when the estimate resets to them (estimator.hpp).
struct RecoverySettings {
  double longest_wait_s = 0.06;     // s that a pose waits for the IMU samples of its time (poses_ahead.hpp)
  double max_lead_s = 0.02;         // s by which a pose may be ahead of the IMU otherwise
  int glitch_poses = 2;             // contradictions in a row that move the estimate no faster than noise
  double step_time_s = 0.05;        // s, assumed duration of a step in the poses
  double sudden = 2.0;              // times outlier_position_m: a first innovation above is a jump
  double swap_rad = 0.35;           // rad of innovation: swapped markers, or another vehicle
  int poses = 5;                    // refused poses in a row, of a continuous stream, before a reset
  double speed = 0.3;               // m/s, standard deviation after a reset
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

// By which estimate a vehicle is flown that brings one of its own (vehicle_odometry): that of motion capture, its own, or its
// own while motion capture is lost.
enum class OdometryUse : std::uint8_t { kMocap, kVehicle, kBoth };

// Estimates are changed without a jump: the difference vanishes no faster than this (estimation/estimate_source.hpp).
struct OdometrySettings {
  OdometryUse use = OdometryUse::kMocap;
  double glide_speed = 0.2;         // m/s, of the position
  double glide_yaw_rate = 0.2;      // rad/s, of the heading
  double glide_acceleration = 1.0;  // m/s^2, of the velocity
};

// The estimator's sensor model. Noise densities are as in data sheets; standard deviations are per axis.
struct EstimatorSettings {
  double accelerometer_noise_density = 4.0e-3;  // m/s^2/sqrt(Hz)
  double gyro_noise_density = 2.0e-4;           // rad/s/sqrt(Hz)
  double accelerometer_bias_walk = 2.0e-2;      // m/s^2/sqrt(s), including a misaligned marker body
  double gyro_bias_walk = 1.0e-4;               // rad/s/sqrt(s)
  double accelerometer_bias_sigma = 0.2;        // m/s^2, before the first pose
  double gyro_bias_sigma = 0.02;                // rad/s, likewise
  double accelerometer_bias_limit = 1.0;        // m/s^2
  double gyro_bias_limit = 0.3;                 // rad/s
  double mocap_position_sigma = 5.0e-5;         // m
  double mocap_orientation_sigma = 7.0e-4;      // rad
  // Gate on the normalised innovation squared, chi-square with 6 degrees of freedom: one good pose in 26,000
  // exceeds 30.
  double gate_chi_square = 30.0;
  double outlier_position_m = 0.05;      // m; a pose beyond the gate and this far off is refused
  double outlier_orientation_rad = 0.1;  // rad, likewise
  // The fastest plausible motion of the vehicle, carried or thrown included. Poses that lie further apart
  // are a step. A faulty gyro is taken to be off by half of max_body_rate at most.
  double max_speed = 4.0;                // m/s
  double max_body_rate = 6.0;            // rad/s
  double start_speed = 1.0;              // m/s, standard deviation at the first pose
  double rotor_speed_bandwidth = 112.0;  // rad/s, correction by measured rotor speeds
  OdometrySettings odometry;
  DetectorSettings detectors;
};

// Limits for arming.
struct ArmingSettings {
  double max_tilt_rad = 0.35;
  double max_speed = 0.3;                 // m/s, of the estimate
  double max_body_rate = 0.2;             // rad/s, bias removed
  double max_specific_force_error = 1.0;  // m/s^2, from gravity in the attitude of the pose
  double max_rotor_speed = 100.0;         // rad/s, of any rotor
  // Largest difference of mass and battery voltages that the vehicle reports from those of its vehicle file, as a fraction.
  double max_vehicle_difference = 0.1;
};

// The action when the link to a ground client is lost whose link-loss failsafe is on.
enum class GroundLinkAction : std::uint8_t { kNone, kHold, kLand };

// Thresholds of the failsafes, and what follows. Times in s.
struct FailsafeSettings {
  double imu_timeout_s = 0.1;             // no usable sample for this time: rotors off
  double imu_gap_s = 0.3;                 // between two samples: rotors off
  double tip_over_tilt_rad = 1.4;         // rad: rotors off
  double impact_acceleration = 100.0;     // m/s^2 of specific force, an impact: rotors off
  double mocap_timeout_s = 0.5;           // no pose for this time: level descent instead of dead reckoning
  double descent_speed = 0.4;             // m/s without position, and upper limit of landings
  double descent_timeout_s = 6.0;         // without position for this time: rotors off
  double low_battery_voltage = 3.3;       // V: land
  double critical_battery_voltage = 3.1;  // V: land faster
  double battery_delay_s = 1.0;           // time that the voltage must stay below
  double battery_timeout_s = 2.0;         // no battery sample for this time: land
  double critical_descent_speed = 0.8;    // m/s, of the faster landing
  double fence_margin_m = 0.2;            // beyond the fence: land inside it
  double setpoint_timeout_s = 0.75;       // no setpoint for this time: hold; 1.5 periods of a 2 Hz stream
  double ground_link_timeout_s = 1.0;     // no heartbeat for this time: ground_link_action
  GroundLinkAction ground_link_action = GroundLinkAction::kLand;
};

struct ControlSettings {
  std::string name;
  AttitudeSettings attitude;
  PositionSettings position;
  DisturbanceSettings disturbance;
  RoughAirSettings rough_air;
  Limits limits;
  EstimatorSettings estimator;
  ArmingSettings arming;
  FailsafeSettings failsafe;
};

// All rules that the settings break. Keys are those of the control settings file ("position.x.omega_n").
std::vector<plant::Violation> validate(const ControlSettings& settings);

}  // namespace swiftlet::control
