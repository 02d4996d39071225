// Visits of the settings of the controller (plant/model/setting.hpp): keys of the control settings file, units, limits, meanings.
// By hand: `name`, and the rules between several settings in validate().
#pragma once

#include <cstddef>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/setting.hpp"

namespace swiftlet::control {

using plant::above;
using plant::at_least;
using plant::between;

// The file has one weight q per state of the model.
template <class Visitor>
void visit(LqrWeights& s, Visitor& v, AttitudeModel model = AttitudeModel::kMotorLag) {
  v({"q", "", {}, "on angle, rate, and moment / inertia; rad^-2, (rad/s)^-2, (rad/s^2)^-2"}, s.q,
    model == AttitudeModel::kMotorLag ? std::size_t{3} : std::size_t{2});
  v({"r", "1", above(0.0), "on the commanded moment / inertia"}, s.r);
}

template <class Visitor>
void visit(AttitudeSettings& s, Visitor& v) {
  v({"model", "of each axis: Eq. (38)-(40), or with the rotor lag as third state"}, s.model,
    {"double_integrator", "motor_lag"});
  v({"error", "of Euler angles, Eq. (29)-(31), or of the rotation"}, s.error, {"euler_angles", "rotation"});
  v({"roll", "of one attitude axis"}, s.roll, s.model);
  v({"pitch", "likewise"}, s.pitch, s.model);
  v({"yaw", "likewise"}, s.yaw, s.model);
  v({"feed_forward", "of the body rates and angular accelerations of the reference"}, s.feed_forward);
}

template <class Visitor>
void visit(RptSettings& s, Visitor& v) {
  v({"omega_n", "rad/s", above(0.0)}, s.omega_n);
  v({"zeta", "1", above(0.0)}, s.zeta);
  v({"epsilon", "1", above(0.0)}, s.epsilon);
  v({"integral_pole", "rad/s", at_least(0.0), "0: no integral"}, s.integral_pole);
}

template <class Visitor>
void visit(PositionSettings& s, Visitor& v) {
  v({"x", "of one position axis, Eq. (49)"}, s.x);
  v({"y", "likewise"}, s.y);
  v({"z", "likewise"}, s.z);
  v({{"integral_limit", "integral_limit_m_s2"}, "m/s^2", at_least(0.0)}, s.integral_limit);
}

template <class Visitor>
void visit(DisturbanceSettings& s, Visitor& v) {
  v({{"bandwidth", "bandwidth_rad_s"}, "rad/s", between(0.0, 500.0), "0: off"},
    s.bandwidth);  // far above that of rotors
  v({{"limit", "limit_m_s2"}, "m/s^2", at_least(0.0)}, s.limit);
}

template <class Visitor>
void visit(RoughAirSettings& s, Visitor& v) {
  v({"law", "how the estimated disturbance is compensated"}, s.law, {"observed", "lead", "incremental"});
  v({"learn_lift", "from lift-off on"}, s.learn_lift);
  v({"thrust_lead", "1", between(0.0, 5.0), "the thrust follows with the rotors' lag over 1 + thrust_lead"},
    s.thrust_lead);
  v({"rotor_radius_m", "m", between(0.0, 1.0), "in ground effect, 0: not modelled"}, s.rotor_radius_m);
  v({"rotor_height_m", "m", between(0.0, 1.0), "above the ground, of a standing vehicle"}, s.rotor_height_m);
}

template <class Visitor>
void visit(Limits& s, Visitor& v) {
  v({"max_tilt_rad", "rad", above(0.0)}, s.max_tilt_rad);
  v({{"max_acceleration", "max_acceleration_m_s2"}, "m/s^2", above(0.0), "feedback"}, s.max_acceleration);
  v({{"max_speed", "max_speed_m_s"}, "m/s", above(0.0), "of planned references"}, s.max_speed);
  v({{"max_reference_acceleration", "max_reference_acceleration_m_s2"}, "m/s^2", above(0.0)},
    s.max_reference_acceleration);
  v({{"max_reference_jerk", "max_reference_jerk_m_s3"}, "m/s^3", above(0.0)}, s.max_reference_jerk);
  v({{"max_yaw_rate", "max_yaw_rate_rad_s"}, "rad/s", above(0.0), "of planned references"}, s.max_yaw_rate);
  v({{"max_body_rate", "max_body_rate_rad_s"}, "rad/s", above(0.0), "of setpoints"}, s.max_body_rate);
  v({{"fence_min_ned", "fence_min_ned_m"}, "m", plant::finite()}, s.fence_min_ned);
  v({{"fence_max_ned", "fence_max_ned_m"}, "m", plant::finite(), "z: the ground"}, s.fence_max_ned);
  v({"min_height_m", "m", above(0.0), "above the ground"}, s.min_height_m);
}

template <class Visitor>
void visit(StuckPoseSettings& s, Visitor& v) {
  v({"same", "m", above(0.0), "poses closer than this repeat"}, s.same);
  v({"distinct", "m", at_least(s.same), "poses further apart show noise"}, s.distinct);
  v({"distinct_poses", "1", at_least(1.0), "in a row, with the rotors off"}, s.distinct_poses);
  v({"repetitions", "1", at_least(1.0), "in a row, of a stuck stream"}, s.repetitions);
}

template <class Visitor>
void visit(PoseContinuitySettings& s, Visitor& v) {
  v({"noise_m", "m", at_least(0.0)}, s.noise_m);
  v({"noise_rad", "rad", at_least(0.0)}, s.noise_rad);
  v({"longest_gap_s", "s", above(0.0), "in which no step and step back can hide"}, s.longest_gap_s);
  v({"lasting_poses", "1", at_least(1.0), "after which a stream is trusted"}, s.lasting_poses);
  v({"lasting_s", "s", at_least(0.0), "likewise"}, s.lasting_s);
}

template <class Visitor>
void visit(ImuSilenceSettings& s, Visitor& v) {
  v({"from_s", "s", above(0.0), "between two samples"}, s.from_s);
  v({"longest_s", "s", at_least(s.from_s), "that is integrated over"}, s.longest_s);
  v({{"acceleration", "acceleration_m_s2"}, "m/s^2", at_least(0.0), "that may be hidden"}, s.acceleration);
  v({{"body_rate", "body_rate_rad_s"}, "rad/s", at_least(0.0), "that a silence may hide"}, s.body_rate);
  v({"turn_rad", "rad", at_least(0.0), "innovation that needs no consistency test"}, s.turn_rad);
  v({"turn_sigmas", "1", at_least(0.0), "likewise"}, s.turn_sigmas);
}

template <class Visitor>
void visit(PoseImuConsistencySettings& s, Visitor& v) {
  v({"interval_s", "s", above(0.0), "between the test's poses"}, s.interval_s);
  v({{"acceleration", "acceleration_m_s2"}, "m/s^2", at_least(0.0), "allowed difference"}, s.acceleration);
  v({"turn_rad", "rad", at_least(0.0), "allowed difference"}, s.turn_rad);
  v({"sigmas", "1", at_least(0.0), "of the pose noise, added to both"}, s.sigmas);
}

template <class Visitor>
void visit(TakeoffConsistencySettings& s, Visitor& v) {
  v({"memory_s", "s", above(0.0), "high-pass time"}, s.memory_s);
  v({"inertial_climb_m", "m", above(0.0), "from which the poses are checked"}, s.inertial_climb_m);
  v({"min_pose_fraction", "1", between(0.0, 1.0), "of the inertial climb"}, s.min_pose_fraction);
  v({"confirmed_climb_m", "m", above(0.0), "that ends the monitoring"}, s.confirmed_climb_m);
  v({"longest_s", "s", at_least(0.0), "that ends the monitoring"}, s.longest_s);
}

template <class Visitor>
void visit(RecoverySettings& s, Visitor& v) {
  v({"longest_wait_s", "s", between(0.0, 0.2), "of a pose for IMU samples", plant::InFile::kOptional},
    s.longest_wait_s);
  v({"max_lead_s", "s", between(0.0, 1.0), "of a pose otherwise"}, s.max_lead_s);
  v({"glitch_poses", "1", at_least(1.0), "contradictions in a row"}, s.glitch_poses);
  v({"step_time_s", "s", above(0.0), "assumed duration of a step"}, s.step_time_s);
  v({"sudden", "1", at_least(1.0), "times outlier_position_m: a jump"}, s.sudden);
  v({"swap_rad", "rad", above(0.0), "innovation of swapped markers"}, s.swap_rad);
  v({"poses", "1", at_least(1.0), "refused in a row before a reset"}, s.poses);
  v({{"speed", "speed_m_s"}, "m/s", above(0.0), "standard deviation after a reset"}, s.speed);
  v({{"gyro_bias", "gyro_bias_rad_s"}, "rad/s", above(0.0), "likewise"}, s.gyro_bias);
  v({{"accelerometer_bias", "accelerometer_bias_m_s2"}, "m/s^2", above(0.0), "likewise"},
    s.accelerometer_bias);
}

template <class Visitor>
void visit(DetectorSettings& s, Visitor& v) {
  v({"stuck_pose", "detects poses that repeat"}, s.stuck_pose);
  v({"continuity", "detects poses that move faster than one body"}, s.continuity);
  v({"imu_silence", "missing IMU samples"}, s.imu_silence);
  v({"pose_imu_consistency", "whether poses and IMU show one motion after a silence"},
    s.pose_imu_consistency);
  v({"takeoff_consistency", "detects a climb that the poses do not show"}, s.takeoff_consistency);
  v({"recovery", "poses that contradict the estimate"}, s.recovery);
}

template <class Visitor>
void visit(OdometrySettings& s, Visitor& v) {
  v({{"use", "estimate"}, "by which a vehicle with an estimate of its own is flown"}, s.use,
    {"mocap", "vehicle", "both"});
  v({{"glide_speed", "glide_speed_m_s"}, "m/s", between(0.01, 1.0)}, s.glide_speed);
  v({{"glide_yaw_rate", "glide_yaw_rate_rad_s"}, "rad/s", between(0.01, 1.0)}, s.glide_yaw_rate);
  v({{"glide_acceleration", "glide_acceleration_m_s2"}, "m/s^2", between(0.1, 10.0)}, s.glide_acceleration);
}

template <class Visitor>
void visit(EstimatorSettings& s, Visitor& v) {
  v({{"accelerometer_noise_density", "accelerometer_noise_m_s2_per_sqrt_hz"}, "m/s^2/sqrt(Hz)", above(0.0)},
    s.accelerometer_noise_density);
  v({{"gyro_noise_density", "gyro_noise_rad_s_per_sqrt_hz"}, "rad/s/sqrt(Hz)", above(0.0)},
    s.gyro_noise_density);
  v({{"accelerometer_bias_walk", "accelerometer_bias_walk_m_s2_per_sqrt_s"}, "m/s^2/sqrt(s)", at_least(0.0)},
    s.accelerometer_bias_walk);
  v({{"gyro_bias_walk", "gyro_bias_walk_rad_s_per_sqrt_s"}, "rad/s/sqrt(s)", at_least(0.0)},
    s.gyro_bias_walk);
  v({{"accelerometer_bias_sigma", "accelerometer_bias_m_s2"},
     "m/s^2",
     at_least(0.0),
     "before the first pose"},
    s.accelerometer_bias_sigma);
  v({{"gyro_bias_sigma", "gyro_bias_rad_s"}, "rad/s", at_least(0.0), "likewise"}, s.gyro_bias_sigma);
  v({{"accelerometer_bias_limit", "accelerometer_bias_limit_m_s2"}, "m/s^2", at_least(0.0)},
    s.accelerometer_bias_limit);
  v({{"gyro_bias_limit", "gyro_bias_limit_rad_s"}, "rad/s", at_least(0.0)}, s.gyro_bias_limit);
  v({{"mocap_position_sigma", "mocap_position_m"}, "m", above(0.0)}, s.mocap_position_sigma);
  v({{"mocap_orientation_sigma", "mocap_orientation_rad"}, "rad", above(0.0)}, s.mocap_orientation_sigma);
  v({"gate_chi_square", "1", above(0.0), "6 degrees of freedom"}, s.gate_chi_square);
  v({"outlier_position_m", "m", above(0.0), "of a pose outside the gate that is refused"},
    s.outlier_position_m);
  v({"outlier_orientation_rad", "rad", above(0.0), "likewise"}, s.outlier_orientation_rad);
  v({{"max_speed", "max_speed_m_s"}, "m/s", above(0.0), "plausible"}, s.max_speed);
  v({{"max_body_rate", "max_body_rate_rad_s"}, "rad/s", above(0.0), "plausible"}, s.max_body_rate);
  v({{"start_speed", "start_speed_m_s"}, "m/s", above(0.0), "deviation at the first pose"}, s.start_speed);
  v({{"rotor_speed_bandwidth", "rotor_speed_bandwidth_rad_s"}, "rad/s", above(0.0)}, s.rotor_speed_bandwidth);
  v({"odometry", "of vehicles with an estimate of their own", plant::InFile::kOptional}, s.odometry);
  v({"detectors", "of faults in the poses"}, s.detectors);
}

template <class Visitor>
void visit(ArmingSettings& s, Visitor& v) {
  v({"max_tilt_rad", "rad", above(0.0)}, s.max_tilt_rad);
  v({{"max_speed", "max_speed_m_s"}, "m/s", above(0.0), "of the estimate"}, s.max_speed);
  v({{"max_body_rate", "max_body_rate_rad_s"}, "rad/s", above(0.0), "bias removed"}, s.max_body_rate);
  v({{"max_specific_force_error", "max_specific_force_error_m_s2"}, "m/s^2", above(0.0), "from gravity"},
    s.max_specific_force_error);
  v({{"max_rotor_speed", "max_rotor_speed_rad_s"}, "rad/s", above(0.0), "of any rotor"}, s.max_rotor_speed);
  v({"max_vehicle_difference", "1", at_least(0.0), "of mass and battery from the vehicle file"},
    s.max_vehicle_difference);
}

template <class Visitor>
void visit(FailsafeSettings& s, Visitor& v) {
  v({"imu_timeout_s", "s", above(0.0), "without a usable sample: rotors off"}, s.imu_timeout_s);
  v({"imu_gap_s", "s", above(0.0), "between two samples: rotors off"}, s.imu_gap_s);
  v({{"impact_acceleration", "impact_m_s2"}, "m/s^2", above(plant::kGravity), "specific force: rotors off"},
    s.impact_acceleration);
  v({"mocap_timeout_s", "s", above(0.0), "without a pose: level descent"}, s.mocap_timeout_s);
  v({{"descent_speed", "descent_speed_m_s"}, "m/s", above(0.0), "upper limit of landings"}, s.descent_speed);
  v({"descent_timeout_s", "s", above(0.0), "without position: rotors off"}, s.descent_timeout_s);
  v({"tip_over_tilt_rad", "rad", above(0.0), "rotors off"}, s.tip_over_tilt_rad);
  v({{"low_battery_voltage", "low_battery_voltage_v"},
     "V",
     at_least(0.0),
     "land; 0: what the battery gives in hover at 5 % of its charge"},
    s.low_battery_voltage);
  v({{"critical_battery_voltage", "critical_battery_voltage_v"},
     "V",
     between(0.0, s.low_battery_voltage),
     "land faster; 0: likewise at 3 %"},
    s.critical_battery_voltage);
  v({"battery_delay_s", "s", at_least(0.0), "that the voltage must stay below"}, s.battery_delay_s);
  v({"battery_timeout_s", "s", above(0.0), "without a battery sample: land"}, s.battery_timeout_s);
  v({{"critical_descent_speed", "critical_descent_speed_m_s"}, "m/s", above(0.0), "of the faster landing"},
    s.critical_descent_speed);
  v({"fence_margin_m", "m", at_least(0.0), "beyond the fence: land inside it"}, s.fence_margin_m);
  v({"setpoint_timeout_s", "s", above(0.0), "without a setpoint: hold"}, s.setpoint_timeout_s);
  v({"ground_link_timeout_s", "s", above(0.0), "no heartbeat: ground_link_action"}, s.ground_link_timeout_s);
  v({"ground_link_action"}, s.ground_link_action, {"none", "hold", "land"});
}

template <class Visitor>
void visit(ControlSettings& s, Visitor& v) {
  v({"attitude", "the attitude law, LQR"}, s.attitude);
  v({"position", "the position law, RPT"}, s.position);
  v({"disturbance", "the disturbance observer"}, s.disturbance);
  v({"rough_air", "in rough air and at take-off", plant::InFile::kOptional}, s.rough_air);
  v({"limits", "limits of flight"}, s.limits);
  v({"estimator", "the sensor model of the estimator"}, s.estimator);
  v({"arming", "limits for arming"}, s.arming);
  v({"failsafe", "thresholds of the failsafes"}, s.failsafe);
}

}  // namespace swiftlet::control
