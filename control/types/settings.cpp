#include "swiftlet/control/types/settings.hpp"

#include <string>

namespace swiftlet::control {

namespace {

using plant::RuleChecker;

constexpr double kMaxTilt = 1.5;                    // rad; some vertical thrust must remain
constexpr double kMaxDisturbanceBandwidth = 500.0;  // rad/s; far above that of rotors
constexpr char kAxis[] = {'x', 'y', 'z'};

void check_weights(const std::string& key, const LqrWeights& weights, RuleChecker& check) {
  check.above(key + ".q[0]", weights.q[0], 0.0);
  check.at_least(key + ".q[1]", weights.q[1], 0.0);
  check.at_least(key + ".q[2]", weights.q[2], 0.0);
  check.above(key + ".r", weights.r, 0.0);
}

void check_rpt(const std::string& key, const RptSettings& rpt, RuleChecker& check) {
  check.above(key + ".omega_n", rpt.omega_n, 0.0);
  check.above(key + ".zeta", rpt.zeta, 0.0);
  check.above(key + ".epsilon", rpt.epsilon, 0.0);
  check.at_least(key + ".integral_pole", rpt.integral_pole, 0.0);
}

void check_limits(const Limits& limits, RuleChecker& check) {
  check.above("limits.max_tilt_rad", limits.max_tilt_rad, 0.0);
  check.between("limits.max_tilt_rad", limits.max_tilt_rad, 0.0, kMaxTilt);
  check.above("limits.max_acceleration_m_s2", limits.max_acceleration, 0.0);
  check.above("limits.max_speed_m_s", limits.max_speed, 0.0);
  check.above("limits.max_reference_acceleration_m_s2", limits.max_reference_acceleration, 0.0);
  check.above("limits.max_reference_jerk_m_s3", limits.max_reference_jerk, 0.0);
  check.above("limits.max_yaw_rate_rad_s", limits.max_yaw_rate, 0.0);
  check.above("limits.max_body_rate_rad_s", limits.max_body_rate, 0.0);
  for (int i = 0; i < 3; ++i) {
    const std::string index = "[" + std::to_string(i) + "]";
    const bool finite = check.finite("limits.fence_min_ned_m" + index, limits.fence_min_ned[i]);
    if (!check.finite("limits.fence_max_ned_m" + index, limits.fence_max_ned[i]) || !finite) continue;
    if (limits.fence_max_ned[i] > limits.fence_min_ned[i]) continue;
    check.add("limits.fence_max_ned_m" + index, "is ", limits.fence_max_ned[i],
              ", must be above fence_min_ned_m in ", kAxis[i], ", ", limits.fence_min_ned[i]);
  }
  if (check.above("limits.min_height_m", limits.min_height_m, 0.0) &&
      limits.min_height_m > -limits.fence_min_ned.z()) {
    check.add("limits.min_height_m", "is ", limits.min_height_m,
              ", must be at most the height of the fence, ", -limits.fence_min_ned.z());
  }
}

void check_estimator(const EstimatorSettings& estimator, RuleChecker& check) {
  check.above("estimator.accelerometer_noise_m_s2_per_sqrt_hz", estimator.accelerometer_noise_density, 0.0);
  check.above("estimator.gyro_noise_rad_s_per_sqrt_hz", estimator.gyro_noise_density, 0.0);
  check.at_least("estimator.accelerometer_bias_walk_m_s2_per_sqrt_s", estimator.accelerometer_bias_walk, 0.0);
  check.at_least("estimator.gyro_bias_walk_rad_s_per_sqrt_s", estimator.gyro_bias_walk, 0.0);
  check.at_least("estimator.accelerometer_bias_m_s2", estimator.accelerometer_bias_sigma, 0.0);
  check.at_least("estimator.gyro_bias_rad_s", estimator.gyro_bias_sigma, 0.0);
  check.at_least("estimator.accelerometer_bias_limit_m_s2", estimator.accelerometer_bias_limit, 0.0);
  check.at_least("estimator.gyro_bias_limit_rad_s", estimator.gyro_bias_limit, 0.0);
  check.above("estimator.mocap_position_m", estimator.mocap_position_sigma, 0.0);
  check.above("estimator.mocap_orientation_rad", estimator.mocap_orientation_sigma, 0.0);
  check.above("estimator.gate_chi_square", estimator.gate_chi_square, 0.0);
  const OdometrySettings& odometry = estimator.odometry;
  check.between("estimator.odometry.glide_speed_m_s", odometry.glide_speed, 0.01, 1.0);
  check.between("estimator.odometry.glide_yaw_rate_rad_s", odometry.glide_yaw_rate, 0.01, 1.0);
  check.between("estimator.odometry.glide_acceleration_m_s2", odometry.glide_acceleration, 0.1, 10.0);
  check.above("estimator.outlier_position_m", estimator.outlier_position_m, 0.0);
  check.above("estimator.outlier_orientation_rad", estimator.outlier_orientation_rad, 0.0);
  check.above("estimator.max_speed_m_s", estimator.max_speed, 0.0);
  check.above("estimator.max_body_rate_rad_s", estimator.max_body_rate, 0.0);
  check.above("estimator.start_speed_m_s", estimator.start_speed, 0.0);
  check.above("estimator.rotor_speed_bandwidth_rad_s", estimator.rotor_speed_bandwidth, 0.0);
}

void check_detectors(const DetectorSettings& detectors, RuleChecker& check) {
  const auto above_0 = [&](const std::string& key, double value) {
    check.above("estimator.detectors." + key, value, 0.0);
  };
  const auto at_least_0 = [&](const std::string& key, double value) {
    check.at_least("estimator.detectors." + key, value, 0.0);
  };
  const auto at_least_1 = [&](const std::string& key, int value) {
    check.at_least("estimator.detectors." + key, value, 1.0);
  };
  const StuckPoseSettings& stuck_pose = detectors.stuck_pose;
  above_0("stuck_pose.same", stuck_pose.same);
  check.at_least("estimator.detectors.stuck_pose.distinct", stuck_pose.distinct, stuck_pose.same);
  at_least_1("stuck_pose.distinct_poses", stuck_pose.distinct_poses);
  at_least_1("stuck_pose.repetitions", stuck_pose.repetitions);

  const PoseContinuitySettings& continuity = detectors.continuity;
  at_least_0("continuity.noise_m", continuity.noise_m);
  at_least_0("continuity.noise_rad", continuity.noise_rad);
  above_0("continuity.longest_gap_s", continuity.longest_gap_s);
  at_least_1("continuity.lasting_poses", continuity.lasting_poses);
  at_least_0("continuity.lasting_s", continuity.lasting_s);

  const ImuSilenceSettings& silence = detectors.imu_silence;
  above_0("imu_silence.from_s", silence.from_s);
  check.at_least("estimator.detectors.imu_silence.longest_s", silence.longest_s, silence.from_s);
  at_least_0("imu_silence.acceleration_m_s2", silence.acceleration);
  at_least_0("imu_silence.body_rate_rad_s", silence.body_rate);
  at_least_0("imu_silence.turn_rad", silence.turn_rad);
  at_least_0("imu_silence.turn_sigmas", silence.turn_sigmas);

  const PoseImuConsistencySettings& trial = detectors.pose_imu_consistency;
  above_0("pose_imu_consistency.interval_s", trial.interval_s);
  at_least_0("pose_imu_consistency.acceleration_m_s2", trial.acceleration);
  at_least_0("pose_imu_consistency.turn_rad", trial.turn_rad);
  at_least_0("pose_imu_consistency.sigmas", trial.sigmas);

  const TakeoffConsistencySettings& climb = detectors.takeoff_consistency;
  above_0("takeoff_consistency.memory_s", climb.memory_s);
  above_0("takeoff_consistency.inertial_climb_m", climb.inertial_climb_m);
  check.between("estimator.detectors.takeoff_consistency.min_pose_fraction", climb.min_pose_fraction, 0.0,
                1.0);
  above_0("takeoff_consistency.confirmed_climb_m", climb.confirmed_climb_m);
  at_least_0("takeoff_consistency.longest_s", climb.longest_s);

  const RecoverySettings& recovery = detectors.recovery;
  check.between("estimator.detectors.recovery.longest_wait_s", recovery.longest_wait_s, 0.0, 0.2);
  check.between("estimator.detectors.recovery.max_lead_s", recovery.max_lead_s, 0.0, 1.0);
  at_least_1("recovery.glitch_poses", recovery.glitch_poses);
  above_0("recovery.step_time_s", recovery.step_time_s);
  check.at_least("estimator.detectors.recovery.sudden", recovery.sudden, 1.0);
  above_0("recovery.swap_rad", recovery.swap_rad);
  at_least_1("recovery.poses", recovery.poses);
  above_0("recovery.speed_m_s", recovery.speed);
  above_0("recovery.gyro_bias_rad_s", recovery.gyro_bias);
  above_0("recovery.accelerometer_bias_m_s2", recovery.accelerometer_bias);
}

void check_arming(const ArmingSettings& arming, RuleChecker& check) {
  check.above("arming.max_tilt_rad", arming.max_tilt_rad, 0.0);
  check.above("arming.max_speed_m_s", arming.max_speed, 0.0);
  check.above("arming.max_body_rate_rad_s", arming.max_body_rate, 0.0);
  check.above("arming.max_specific_force_error_m_s2", arming.max_specific_force_error, 0.0);
  check.above("arming.max_rotor_speed_rad_s", arming.max_rotor_speed, 0.0);
}

void check_failsafe(const FailsafeSettings& failsafe, const Limits& limits, RuleChecker& check) {
  check.above("failsafe.imu_timeout_s", failsafe.imu_timeout_s, 0.0);
  check.above("failsafe.imu_gap_s", failsafe.imu_gap_s, 0.0);
  check.above("failsafe.impact_m_s2", failsafe.impact_acceleration, plant::kGravity);
  check.above("failsafe.mocap_timeout_s", failsafe.mocap_timeout_s, 0.0);
  check.above("failsafe.descent_speed_m_s", failsafe.descent_speed, 0.0);
  check.above("failsafe.descent_timeout_s", failsafe.descent_timeout_s, 0.0);
  if (check.above("failsafe.tip_over_tilt_rad", failsafe.tip_over_tilt_rad, 0.0) &&
      failsafe.tip_over_tilt_rad <= limits.max_tilt_rad) {
    check.add("failsafe.tip_over_tilt_rad", "is ", failsafe.tip_over_tilt_rad,
              ", must be above limits.max_tilt_rad, ", limits.max_tilt_rad);
  }
  if (check.at_least("failsafe.low_battery_voltage_v", failsafe.low_battery_voltage, 0.0)) {
    check.between("failsafe.critical_battery_voltage_v", failsafe.critical_battery_voltage, 0.0,
                  failsafe.low_battery_voltage);
  }
  check.at_least("failsafe.battery_delay_s", failsafe.battery_delay_s, 0.0);
  check.above("failsafe.battery_timeout_s", failsafe.battery_timeout_s, 0.0);
  check.above("failsafe.critical_descent_speed_m_s", failsafe.critical_descent_speed, 0.0);
  check.at_least("failsafe.fence_margin_m", failsafe.fence_margin_m, 0.0);
  check.above("failsafe.setpoint_timeout_s", failsafe.setpoint_timeout_s, 0.0);
  check.above("failsafe.ground_link_timeout_s", failsafe.ground_link_timeout_s, 0.0);
}

}  // namespace

std::vector<plant::Violation> validate(const ControlSettings& settings) {
  RuleChecker check;
  if (settings.name.empty()) check.add("name", "is empty, must be given");
  check_weights("attitude.roll", settings.attitude.roll, check);
  check_weights("attitude.pitch", settings.attitude.pitch, check);
  check_weights("attitude.yaw", settings.attitude.yaw, check);
  check_rpt("position.x", settings.position.x, check);
  check_rpt("position.y", settings.position.y, check);
  check_rpt("position.z", settings.position.z, check);
  check.at_least("position.integral_limit_m_s2", settings.position.integral_limit, 0.0);
  check.between("disturbance.bandwidth_rad_s", settings.disturbance.bandwidth, 0.0, kMaxDisturbanceBandwidth);
  check.at_least("disturbance.limit_m_s2", settings.disturbance.limit, 0.0);
  check.between("rough_air.thrust_lead", settings.rough_air.thrust_lead, 0.0, 5.0);
  check.between("rough_air.rotor_radius_m", settings.rough_air.rotor_radius_m, 0.0, 1.0);
  check.between("rough_air.rotor_height_m", settings.rough_air.rotor_height_m, 0.0, 1.0);
  check_limits(settings.limits, check);
  check_estimator(settings.estimator, check);
  check_detectors(settings.estimator.detectors, check);
  check_arming(settings.arming, check);
  check_failsafe(settings.failsafe, settings.limits, check);
  return check.take();
}

}  // namespace swiftlet::control
