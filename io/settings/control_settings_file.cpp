#include "swiftlet/io/settings/control_settings_file.hpp"

#include "swiftlet/io/config.hpp"
#include "swiftlet/io/settings/violations.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {

namespace {

// The list q has one weight per state of the model.
control::LqrWeights read_weights(const ConfigNode& node, control::AttitudeModel model) {
  const std::size_t states = model == control::AttitudeModel::kMotorLag ? 3 : 2;
  const std::vector<double> q = node.at("q").numbers(states, states);
  control::LqrWeights weights;
  for (std::size_t i = 0; i < states; ++i) weights.q[static_cast<Eigen::Index>(i)] = q[i];
  weights.r = node.at("r").number();
  return weights;
}

control::AttitudeSettings read_attitude(const ConfigNode& node) {
  control::AttitudeSettings attitude;
  attitude.model = node.at("model").choice<control::AttitudeModel>(
      {{"double_integrator", control::AttitudeModel::kDoubleIntegrator},
       {"motor_lag", control::AttitudeModel::kMotorLag}});
  attitude.error = node.at("error").choice<control::AttitudeErrorKind>(
      {{"euler_angles", control::AttitudeErrorKind::kEulerAngles},
       {"rotation", control::AttitudeErrorKind::kRotation}});
  attitude.roll = read_weights(node.at("roll"), attitude.model);
  attitude.pitch = read_weights(node.at("pitch"), attitude.model);
  attitude.yaw = read_weights(node.at("yaw"), attitude.model);
  attitude.feed_forward = node.at("feed_forward").boolean();
  return attitude;
}

control::RptSettings read_rpt(const ConfigNode& node) {
  control::RptSettings rpt;
  rpt.omega_n = node.at("omega_n").number();
  rpt.zeta = node.at("zeta").number();
  rpt.epsilon = node.at("epsilon").number();
  rpt.integral_pole = node.at("integral_pole").number();
  return rpt;
}

control::PositionSettings read_position(const ConfigNode& node) {
  control::PositionSettings position;
  position.x = read_rpt(node.at("x"));
  position.y = read_rpt(node.at("y"));
  position.z = read_rpt(node.at("z"));
  position.integral_limit = node.at("integral_limit_m_s2").number();
  return position;
}

control::DisturbanceSettings read_disturbance(const ConfigNode& node) {
  control::DisturbanceSettings disturbance;
  disturbance.bandwidth = node.at("bandwidth_rad_s").number();
  disturbance.limit = node.at("limit_m_s2").number();
  return disturbance;
}

control::RoughAirSettings read_rough_air(const ConfigNode& node) {
  control::RoughAirSettings rough_air;
  rough_air.law = node.at("law").choice<control::DisturbanceLaw>(
      {{"observed", control::DisturbanceLaw::kObserved},
       {"lead", control::DisturbanceLaw::kLead},
       {"incremental", control::DisturbanceLaw::kIncremental}});
  rough_air.learn_lift = node.at("learn_lift").boolean();
  rough_air.thrust_lead = node.at("thrust_lead").number();
  rough_air.rotor_radius_m = node.at("rotor_radius_m").number();
  rough_air.rotor_height_m = node.at("rotor_height_m").number();
  return rough_air;
}

control::Limits read_limits(const ConfigNode& node) {
  control::Limits limits;
  limits.max_tilt_rad = node.at("max_tilt_rad").number();
  limits.max_acceleration = node.at("max_acceleration_m_s2").number();
  limits.max_speed = node.at("max_speed_m_s").number();
  limits.max_reference_acceleration = node.at("max_reference_acceleration_m_s2").number();
  limits.max_reference_jerk = node.at("max_reference_jerk_m_s3").number();
  limits.max_yaw_rate = node.at("max_yaw_rate_rad_s").number();
  limits.max_body_rate = node.at("max_body_rate_rad_s").number();
  limits.fence_min_ned = node.at("fence_min_ned_m").vector3();
  limits.fence_max_ned = node.at("fence_max_ned_m").vector3();
  limits.min_height_m = node.at("min_height_m").number();
  return limits;
}

int read_count(const ConfigNode& node) { return static_cast<int>(node.integer(1, 1'000'000)); }

control::DetectorSettings read_detectors(const ConfigNode& node) {
  control::DetectorSettings detectors;
  const ConfigNode stuck_pose = node.at("stuck_pose");
  detectors.stuck_pose.same = stuck_pose.at("same").number();
  detectors.stuck_pose.distinct = stuck_pose.at("distinct").number();
  detectors.stuck_pose.distinct_poses = read_count(stuck_pose.at("distinct_poses"));
  detectors.stuck_pose.repetitions = read_count(stuck_pose.at("repetitions"));
  const ConfigNode continuity = node.at("continuity");
  detectors.continuity.noise_m = continuity.at("noise_m").number();
  detectors.continuity.noise_rad = continuity.at("noise_rad").number();
  detectors.continuity.longest_gap_s = continuity.at("longest_gap_s").number();
  detectors.continuity.lasting_poses = read_count(continuity.at("lasting_poses"));
  detectors.continuity.lasting_s = continuity.at("lasting_s").number();
  const ConfigNode imu_silence = node.at("imu_silence");
  detectors.imu_silence.from_s = imu_silence.at("from_s").number();
  detectors.imu_silence.longest_s = imu_silence.at("longest_s").number();
  detectors.imu_silence.acceleration = imu_silence.at("acceleration_m_s2").number();
  detectors.imu_silence.body_rate = imu_silence.at("body_rate_rad_s").number();
  detectors.imu_silence.turn_rad = imu_silence.at("turn_rad").number();
  detectors.imu_silence.turn_sigmas = imu_silence.at("turn_sigmas").number();
  const ConfigNode pose_imu_consistency = node.at("pose_imu_consistency");
  detectors.pose_imu_consistency.interval_s = pose_imu_consistency.at("interval_s").number();
  detectors.pose_imu_consistency.acceleration = pose_imu_consistency.at("acceleration_m_s2").number();
  detectors.pose_imu_consistency.turn_rad = pose_imu_consistency.at("turn_rad").number();
  detectors.pose_imu_consistency.sigmas = pose_imu_consistency.at("sigmas").number();
  const ConfigNode takeoff_consistency = node.at("takeoff_consistency");
  detectors.takeoff_consistency.memory_s = takeoff_consistency.at("memory_s").number();
  detectors.takeoff_consistency.inertial_climb_m = takeoff_consistency.at("inertial_climb_m").number();
  detectors.takeoff_consistency.min_pose_fraction = takeoff_consistency.at("min_pose_fraction").number();
  detectors.takeoff_consistency.confirmed_climb_m = takeoff_consistency.at("confirmed_climb_m").number();
  detectors.takeoff_consistency.longest_s = takeoff_consistency.at("longest_s").number();
  const ConfigNode recovery = node.at("recovery");
  if (const auto wait = recovery.find("longest_wait_s")) detectors.recovery.longest_wait_s = wait->number();
  detectors.recovery.max_lead_s = recovery.at("max_lead_s").number();
  detectors.recovery.glitch_poses = read_count(recovery.at("glitch_poses"));
  detectors.recovery.step_time_s = recovery.at("step_time_s").number();
  detectors.recovery.sudden = recovery.at("sudden").number();
  detectors.recovery.swap_rad = recovery.at("swap_rad").number();
  detectors.recovery.poses = read_count(recovery.at("poses"));
  detectors.recovery.speed = recovery.at("speed_m_s").number();
  detectors.recovery.gyro_bias = recovery.at("gyro_bias_rad_s").number();
  detectors.recovery.accelerometer_bias = recovery.at("accelerometer_bias_m_s2").number();
  return detectors;
}

control::OdometrySettings read_odometry_use(const ConfigNode& node) {
  control::OdometrySettings odometry;
  odometry.use = node.at("estimate")
                     .choice<control::OdometryUse>({{"mocap", control::OdometryUse::kMocap},
                                                    {"vehicle", control::OdometryUse::kVehicle},
                                                    {"both", control::OdometryUse::kBoth}});
  odometry.glide_speed = node.at("glide_speed_m_s").number();
  odometry.glide_yaw_rate = node.at("glide_yaw_rate_rad_s").number();
  odometry.glide_acceleration = node.at("glide_acceleration_m_s2").number();
  return odometry;
}

control::EstimatorSettings read_estimator(const ConfigNode& node) {
  control::EstimatorSettings estimator;
  estimator.accelerometer_noise_density = node.at("accelerometer_noise_m_s2_per_sqrt_hz").number();
  estimator.gyro_noise_density = node.at("gyro_noise_rad_s_per_sqrt_hz").number();
  estimator.accelerometer_bias_walk = node.at("accelerometer_bias_walk_m_s2_per_sqrt_s").number();
  estimator.gyro_bias_walk = node.at("gyro_bias_walk_rad_s_per_sqrt_s").number();
  estimator.accelerometer_bias_sigma = node.at("accelerometer_bias_m_s2").number();
  estimator.gyro_bias_sigma = node.at("gyro_bias_rad_s").number();
  estimator.accelerometer_bias_limit = node.at("accelerometer_bias_limit_m_s2").number();
  estimator.gyro_bias_limit = node.at("gyro_bias_limit_rad_s").number();
  estimator.mocap_position_sigma = node.at("mocap_position_m").number();
  estimator.mocap_orientation_sigma = node.at("mocap_orientation_rad").number();
  estimator.gate_chi_square = node.at("gate_chi_square").number();
  estimator.outlier_position_m = node.at("outlier_position_m").number();
  estimator.outlier_orientation_rad = node.at("outlier_orientation_rad").number();
  estimator.max_speed = node.at("max_speed_m_s").number();
  estimator.max_body_rate = node.at("max_body_rate_rad_s").number();
  estimator.start_speed = node.at("start_speed_m_s").number();
  estimator.rotor_speed_bandwidth = node.at("rotor_speed_bandwidth_rad_s").number();
  if (const auto odometry = node.find("odometry")) estimator.odometry = read_odometry_use(*odometry);
  estimator.detectors = read_detectors(node.at("detectors"));
  return estimator;
}

control::ArmingSettings read_arming(const ConfigNode& node) {
  control::ArmingSettings arming;
  arming.max_tilt_rad = node.at("max_tilt_rad").number();
  arming.max_speed = node.at("max_speed_m_s").number();
  arming.max_body_rate = node.at("max_body_rate_rad_s").number();
  arming.max_specific_force_error = node.at("max_specific_force_error_m_s2").number();
  arming.max_rotor_speed = node.at("max_rotor_speed_rad_s").number();
  return arming;
}

control::FailsafeSettings read_failsafe(const ConfigNode& node) {
  control::FailsafeSettings failsafe;
  failsafe.imu_timeout_s = node.at("imu_timeout_s").number();
  failsafe.imu_gap_s = node.at("imu_gap_s").number();
  failsafe.impact_acceleration = node.at("impact_m_s2").number();
  failsafe.mocap_timeout_s = node.at("mocap_timeout_s").number();
  failsafe.descent_speed = node.at("descent_speed_m_s").number();
  failsafe.descent_timeout_s = node.at("descent_timeout_s").number();
  failsafe.tip_over_tilt_rad = node.at("tip_over_tilt_rad").number();
  failsafe.low_battery_voltage = node.at("low_battery_voltage_v").number();
  failsafe.critical_battery_voltage = node.at("critical_battery_voltage_v").number();
  failsafe.battery_delay_s = node.at("battery_delay_s").number();
  failsafe.battery_timeout_s = node.at("battery_timeout_s").number();
  failsafe.critical_descent_speed = node.at("critical_descent_speed_m_s").number();
  failsafe.fence_margin_m = node.at("fence_margin_m").number();
  failsafe.setpoint_timeout_s = node.at("setpoint_timeout_s").number();
  failsafe.ground_link_timeout_s = node.at("ground_link_timeout_s").number();
  failsafe.ground_link_action =
      node.at("ground_link_action")
          .choice<control::GroundLinkAction>({{"none", control::GroundLinkAction::kNone},
                                              {"hold", control::GroundLinkAction::kHold},
                                              {"land", control::GroundLinkAction::kLand}});
  return failsafe;
}

}  // namespace

control::ControlSettings parse_control_settings(std::string_view text, const std::string& file_name) {
  const ConfigNode root = parse_config(text, file_name);
  control::ControlSettings settings;
  root.read_known([&] {
    settings.name = root.at("name").text();
    settings.attitude = read_attitude(root.at("attitude"));
    settings.position = read_position(root.at("position"));
    settings.disturbance = read_disturbance(root.at("disturbance"));
    if (const auto air = root.find("rough_air")) settings.rough_air = read_rough_air(*air);
    settings.limits = read_limits(root.at("limits"));
    settings.estimator = read_estimator(root.at("estimator"));
    settings.arming = read_arming(root.at("arming"));
    settings.failsafe = read_failsafe(root.at("failsafe"));
  });
  reject_violations(root, control::validate(settings));
  return settings;
}

control::ControlSettings load_control_settings(const std::string& path) {
  return parse_control_settings(read_text_file(path), path);
}

}  // namespace swiftlet::io
