#include "swiftlet/io/settings/control_settings_file.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "swiftlet/io/text_file.hpp"
#include "tests/support/paths.hpp"
#include "tests/unit/io/config_error_check.hpp"

namespace swiftlet::io::control_settings_file_test {

using control::AttitudeModel;
using control::ControlSettings;
using tests::refusal;

std::string file(const std::string& name) {
  return read_text_file(tests::in_source("config/control/") + name + ".yaml");
}

TEST(ControlSettingsFile, LoadsBothConfigurations) {
  EXPECT_EQ(parse_control_settings(file("motor_lag"), "c.yaml").attitude.model, AttitudeModel::kMotorLag);
  EXPECT_EQ(parse_control_settings(file("paper"), "c.yaml").attitude.model, AttitudeModel::kDoubleIntegrator);
}

TEST(ControlSettingsFile, ReadsEveryKeyIntoItsMember) {
  const ControlSettings s = parse_control_settings(
      "name: n\n"
      "attitude:\n"
      "  model: motor_lag\n"
      "  error: rotation\n"
      "  roll: {q: [1, 2, 3], r: 4}\n"
      "  pitch: {q: [5, 6, 7], r: 8}\n"
      "  yaw: {q: [9, 10, 11], r: 12}\n"
      "  feed_forward: false\n"
      "position:\n"
      "  x: {omega_n: 13, zeta: 14, epsilon: 15, integral_pole: 16}\n"
      "  y: {omega_n: 17, zeta: 18, epsilon: 19, integral_pole: 20}\n"
      "  z: {omega_n: 21, zeta: 22, epsilon: 23, integral_pole: 24}\n"
      "  integral_limit_m_s2: 25\n"
      "disturbance:\n"
      "  bandwidth_rad_s: 47\n"
      "  limit_m_s2: 48\n"
      "rough_air:\n"
      "  law: observed\n"
      "  learn_lift: false\n"
      "  thrust_lead: 2.5\n"
      "  rotor_radius_m: 0.041\n"
      "  rotor_height_m: 0.042\n"
      "limits:\n"
      "  max_tilt_rad: 0.26\n"
      "  max_acceleration_m_s2: 27\n"
      "  max_speed_m_s: 28\n"
      "  max_reference_acceleration_m_s2: 29\n"
      "  max_reference_jerk_m_s3: 29.5\n"
      "  max_yaw_rate_rad_s: 30\n"
      "  max_body_rate_rad_s: 30.5\n"
      "  fence_min_ned_m: [-31, -32, -33]\n"
      "  fence_max_ned_m: [34, 35, 36]\n"
      "  min_height_m: 32.5\n"
      "estimator:\n"
      "  accelerometer_noise_m_s2_per_sqrt_hz: 50\n"
      "  gyro_noise_rad_s_per_sqrt_hz: 51\n"
      "  accelerometer_bias_walk_m_s2_per_sqrt_s: 52\n"
      "  gyro_bias_walk_rad_s_per_sqrt_s: 53\n"
      "  accelerometer_bias_m_s2: 54\n"
      "  gyro_bias_rad_s: 55\n"
      "  accelerometer_bias_limit_m_s2: 39\n"
      "  gyro_bias_limit_rad_s: 40\n"
      "  mocap_position_m: 56\n"
      "  mocap_orientation_rad: 57\n"
      "  gate_chi_square: 58\n"
      "  outlier_position_m: 59\n"
      "  outlier_orientation_rad: 60\n"
      "  max_speed_m_s: 61\n"
      "  max_body_rate_rad_s: 62\n"
      "  start_speed_m_s: 63\n"
      "  rotor_speed_bandwidth_rad_s: 64\n"
      "  odometry: {estimate: both, glide_speed_m_s: 0.3, glide_yaw_rate_rad_s: 0.4, "
      "glide_acceleration_m_s2: 0.5}\n"
      "  detectors:\n"
      "    stuck_pose: {same: 1, distinct: 2, distinct_poses: 3, repetitions: 4}\n"
      "    continuity: {noise_m: 5, noise_rad: 6, longest_gap_s: 7, lasting_poses: 8, lasting_s: 9}\n"
      "    imu_silence: {from_s: 10, longest_s: 11, acceleration_m_s2: 12, body_rate_rad_s: 13, turn_rad: "
      "14,\n"
      "      turn_sigmas: 15}\n"
      "    pose_imu_consistency: {interval_s: 16, acceleration_m_s2: 17, turn_rad: 18, sigmas: 19}\n"
      "    takeoff_consistency: {memory_s: 20, inertial_climb_m: 21, min_pose_fraction: 0.22, "
      "confirmed_climb_m: 23, longest_s: "
      "24}\n"
      "    recovery: {longest_wait_s: 0.15, max_lead_s: 0.25, glitch_poses: 26, step_time_s: 27, sudden: 28, "
      "swap_rad: 29, poses: "
      "30,\n"
      "      speed_m_s: 31, gyro_bias_rad_s: 32, accelerometer_bias_m_s2: 33}\n"
      "arming:\n"
      "  max_tilt_rad: 0.41\n"
      "  max_speed_m_s: 42\n"
      "  max_body_rate_rad_s: 43\n"
      "  max_specific_force_error_m_s2: 44\n"
      "  max_rotor_speed_rad_s: 45\n"
      "  max_vehicle_difference: 0.62\n"
      "failsafe:\n"
      "  imu_timeout_s: 46\n"
      "  imu_gap_s: 47\n"
      "  impact_m_s2: 61\n"
      "  mocap_timeout_s: 48\n"
      "  descent_speed_m_s: 49\n"
      "  descent_timeout_s: 50\n"
      "  tip_over_tilt_rad: 51\n"
      "  low_battery_voltage_v: 53\n"
      "  critical_battery_voltage_v: 52\n"
      "  battery_delay_s: 54\n"
      "  battery_timeout_s: 55\n"
      "  critical_descent_speed_m_s: 56\n"
      "  fence_margin_m: 57\n"
      "  setpoint_timeout_s: 58\n"
      "  ground_link_timeout_s: 59\n"
      "  ground_link_action: hold\n",
      "c.yaml");
  EXPECT_EQ(s.name, "n");
  EXPECT_EQ(s.attitude.roll.q, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(s.attitude.roll.r, 4);
  EXPECT_EQ(s.attitude.pitch.q, Eigen::Vector3d(5, 6, 7));
  EXPECT_EQ(s.attitude.pitch.r, 8);
  EXPECT_EQ(s.attitude.yaw.q, Eigen::Vector3d(9, 10, 11));
  EXPECT_EQ(s.attitude.yaw.r, 12);
  EXPECT_FALSE(s.attitude.feed_forward);
  double value = 13;
  for (const control::RptSettings* rpt : {&s.position.x, &s.position.y, &s.position.z}) {
    EXPECT_EQ(rpt->omega_n, value++);
    EXPECT_EQ(rpt->zeta, value++);
    EXPECT_EQ(rpt->epsilon, value++);
    EXPECT_EQ(rpt->integral_pole, value++);
  }
  EXPECT_EQ(s.position.integral_limit, 25);
  EXPECT_EQ(s.disturbance.bandwidth, 47);
  EXPECT_EQ(s.disturbance.limit, 48);
  EXPECT_EQ(s.rough_air.law, control::DisturbanceLaw::kObserved);
  EXPECT_FALSE(s.rough_air.learn_lift);
  EXPECT_EQ(s.rough_air.thrust_lead, 2.5);
  EXPECT_EQ(s.rough_air.rotor_radius_m, 0.041);
  EXPECT_EQ(s.rough_air.rotor_height_m, 0.042);
  EXPECT_EQ(s.limits.max_tilt_rad, 0.26);
  EXPECT_EQ(s.limits.max_acceleration, 27);
  EXPECT_EQ(s.limits.max_speed, 28);
  EXPECT_EQ(s.limits.max_reference_acceleration, 29);
  EXPECT_EQ(s.limits.max_reference_jerk, 29.5);
  EXPECT_EQ(s.limits.max_yaw_rate, 30);
  EXPECT_EQ(s.limits.max_body_rate, 30.5);
  EXPECT_EQ(s.limits.fence_min_ned, Eigen::Vector3d(-31, -32, -33));
  EXPECT_EQ(s.limits.fence_max_ned, Eigen::Vector3d(34, 35, 36));
  EXPECT_EQ(s.limits.min_height_m, 32.5);
  EXPECT_EQ(s.estimator.accelerometer_noise_density, 50);
  EXPECT_EQ(s.estimator.gyro_noise_density, 51);
  EXPECT_EQ(s.estimator.accelerometer_bias_walk, 52);
  EXPECT_EQ(s.estimator.gyro_bias_walk, 53);
  EXPECT_EQ(s.estimator.accelerometer_bias_sigma, 54);
  EXPECT_EQ(s.estimator.gyro_bias_sigma, 55);
  EXPECT_EQ(s.estimator.accelerometer_bias_limit, 39);
  EXPECT_EQ(s.estimator.gyro_bias_limit, 40);
  EXPECT_EQ(s.estimator.mocap_position_sigma, 56);
  EXPECT_EQ(s.estimator.mocap_orientation_sigma, 57);
  EXPECT_EQ(s.estimator.gate_chi_square, 58);
  EXPECT_EQ(s.estimator.odometry.use, control::OdometryUse::kBoth);
  EXPECT_EQ(s.estimator.odometry.glide_speed, 0.3);
  EXPECT_EQ(s.estimator.odometry.glide_yaw_rate, 0.4);
  EXPECT_EQ(s.estimator.odometry.glide_acceleration, 0.5);
  EXPECT_EQ(s.estimator.outlier_position_m, 59);
  EXPECT_EQ(s.estimator.outlier_orientation_rad, 60);
  EXPECT_EQ(s.estimator.max_speed, 61);
  EXPECT_EQ(s.estimator.max_body_rate, 62);
  EXPECT_EQ(s.estimator.start_speed, 63);
  EXPECT_EQ(s.estimator.rotor_speed_bandwidth, 64);
  const control::DetectorSettings& d = s.estimator.detectors;
  EXPECT_EQ(d.stuck_pose.same, 1);
  EXPECT_EQ(d.stuck_pose.distinct, 2);
  EXPECT_EQ(d.stuck_pose.distinct_poses, 3);
  EXPECT_EQ(d.stuck_pose.repetitions, 4);
  EXPECT_EQ(d.continuity.noise_m, 5);
  EXPECT_EQ(d.continuity.noise_rad, 6);
  EXPECT_EQ(d.continuity.longest_gap_s, 7);
  EXPECT_EQ(d.continuity.lasting_poses, 8);
  EXPECT_EQ(d.continuity.lasting_s, 9);
  EXPECT_EQ(d.imu_silence.from_s, 10);
  EXPECT_EQ(d.imu_silence.longest_s, 11);
  EXPECT_EQ(d.imu_silence.acceleration, 12);
  EXPECT_EQ(d.imu_silence.body_rate, 13);
  EXPECT_EQ(d.imu_silence.turn_rad, 14);
  EXPECT_EQ(d.imu_silence.turn_sigmas, 15);
  EXPECT_EQ(d.pose_imu_consistency.interval_s, 16);
  EXPECT_EQ(d.pose_imu_consistency.acceleration, 17);
  EXPECT_EQ(d.pose_imu_consistency.turn_rad, 18);
  EXPECT_EQ(d.pose_imu_consistency.sigmas, 19);
  EXPECT_EQ(d.takeoff_consistency.memory_s, 20);
  EXPECT_EQ(d.takeoff_consistency.inertial_climb_m, 21);
  EXPECT_EQ(d.takeoff_consistency.min_pose_fraction, 0.22);
  EXPECT_EQ(d.takeoff_consistency.confirmed_climb_m, 23);
  EXPECT_EQ(d.takeoff_consistency.longest_s, 24);
  EXPECT_EQ(d.recovery.longest_wait_s, 0.15);
  EXPECT_EQ(d.recovery.max_lead_s, 0.25);
  EXPECT_EQ(d.recovery.glitch_poses, 26);
  EXPECT_EQ(d.recovery.step_time_s, 27);
  EXPECT_EQ(d.recovery.sudden, 28);
  EXPECT_EQ(d.recovery.swap_rad, 29);
  EXPECT_EQ(d.recovery.poses, 30);
  EXPECT_EQ(d.recovery.speed, 31);
  EXPECT_EQ(d.recovery.gyro_bias, 32);
  EXPECT_EQ(d.recovery.accelerometer_bias, 33);
  EXPECT_EQ(s.arming.max_tilt_rad, 0.41);
  EXPECT_EQ(s.arming.max_speed, 42);
  EXPECT_EQ(s.arming.max_body_rate, 43);
  EXPECT_EQ(s.arming.max_specific_force_error, 44);
  EXPECT_EQ(s.arming.max_rotor_speed, 45);
  EXPECT_EQ(s.arming.max_vehicle_difference, 0.62);
  EXPECT_EQ(s.failsafe.imu_timeout_s, 46);
  EXPECT_EQ(s.failsafe.imu_gap_s, 47);
  EXPECT_EQ(s.failsafe.impact_acceleration, 61);
  EXPECT_EQ(s.failsafe.mocap_timeout_s, 48);
  EXPECT_EQ(s.failsafe.descent_speed, 49);
  EXPECT_EQ(s.failsafe.descent_timeout_s, 50);
  EXPECT_EQ(s.failsafe.tip_over_tilt_rad, 51);
  EXPECT_EQ(s.failsafe.low_battery_voltage, 53);
  EXPECT_EQ(s.failsafe.critical_battery_voltage, 52);
  EXPECT_EQ(s.failsafe.battery_delay_s, 54);
  EXPECT_EQ(s.failsafe.battery_timeout_s, 55);
  EXPECT_EQ(s.failsafe.critical_descent_speed, 56);
  EXPECT_EQ(s.failsafe.fence_margin_m, 57);
  EXPECT_EQ(s.failsafe.setpoint_timeout_s, 58);
  EXPECT_EQ(s.failsafe.ground_link_timeout_s, 59);
  EXPECT_EQ(s.failsafe.ground_link_action, control::GroundLinkAction::kHold);
}

TEST(ControlSettingsFile, RefusesEveryTruncation) {
  for (const char* name : {"motor_lag", "paper"}) {
    const std::string text = file(name);
    for (std::size_t length = 0; length < text.size(); ++length) {
      EXPECT_THROW(parse_control_settings(text.substr(0, length), "c.yaml"), ConfigError) << length;
    }
  }
}

TEST(ControlSettingsFile, RequiresEveryKey) {
  for (const char* name : {"motor_lag", "paper"}) {
    const std::string text = file(name);
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = text.find('\n', begin) + 1;
      const std::string line = text.substr(begin, end - begin);
      const std::size_t first = line.find_first_not_of(' ');
      const bool optional = line.compare(first, 9, "odometry:") == 0;
      if (line[first] != '#' && line[first] != '\n' && !optional) {
        std::string without = text;
        without.erase(begin, end - begin);
        EXPECT_THROW(parse_control_settings(without, "c.yaml"), ConfigError) << line;
      }
      begin = end;
    }
  }
}

struct Fault {
  const char* key;    // as in the message
  const char* value;  // replaces that of the key
  const char* message;
};
void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.key << ": " << fault.value; }

class SettingsFaults : public testing::TestWithParam<Fault> {};

// paper.yaml with another value for the key "section.name"; `line` becomes that of the key.
std::string with_value(const Fault& fault, int& line) {
  std::string text = file("paper");
  const std::string key = fault.key;
  std::size_t at = 0;
  std::size_t begin = 0;
  while (begin < key.size()) {
    const std::size_t end = std::min(key.find('.', begin), key.size());
    at = text.find(key.substr(begin, end - begin) + ":", at);
    EXPECT_NE(at, std::string::npos) << key;
    begin = end + 1;
  }
  at = text.find(':', at) + 1;
  line = 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
  const std::size_t end = text[at + 1] == '['
                              ? text.find(']', at) + 1
                              : std::min(text.find_first_of(",}\n", at), text.find("  #", at));
  return text.replace(at, end - at, std::string(" ") + fault.value);
}

TEST_P(SettingsFaults, AreNamedWithLineKeyValueAndLimit) {
  int line = 0;
  const std::string text = with_value(GetParam(), line);
  const std::string sentence = refusal([&] { parse_control_settings(text, "c.yaml"); });
  EXPECT_EQ(sentence.rfind("c.yaml:" + std::to_string(line) + ": " + GetParam().key, 0), 0U) << sentence;
  EXPECT_NE(sentence.find(GetParam().message), std::string::npos) << sentence;
}

const Fault kFaults[] = {
    {"attitude.model", "lqr", "is lqr, must be double_integrator or motor_lag"},
    {"attitude.roll.q", "[625, 0, 0]", "is a list of 3, must be a list of 2"},
    {"attitude.roll.q", "[0, 1]", "[0]: is 0, must be a finite number above 0"},
    {"attitude.pitch.q", "[1, -1]", "[1]: is -1, must be a finite number of at least 0"},
    {"attitude.yaw.r", "0", "is 0, must be a finite number above 0"},
    {"attitude.feed_forward", "maybe", "is maybe, must be true or false"},
    {"position.x.omega_n", "0", "is 0, must be a finite number above 0"},
    {"position.y.zeta", "-1", "above 0"},
    {"position.z.epsilon", ".inf", "must be a finite number"},
    {"position.x.integral_pole", "-0.1", "at least 0"},
    {"position.integral_limit_m_s2", "-2", "at least 0"},
    {"disturbance.bandwidth_rad_s", "-2", "at least 0"},
    {"disturbance.bandwidth_rad_s", "501", "at most 500"},
    {"disturbance.limit_m_s2", "-2", "at least 0"},
    {"limits.max_tilt_rad", "0", "above 0"},
    {"limits.max_tilt_rad", "1.6", "is 1.6, must be at least 0 and at most 1.5"},
    {"limits.max_acceleration_m_s2", "0", "above 0"},
    {"limits.max_speed_m_s", "0", "above 0"},
    {"limits.max_reference_acceleration_m_s2", "0", "above 0"},
    {"limits.max_reference_jerk_m_s3", "-1", "above 0"},
    {"limits.max_yaw_rate_rad_s", "0", "above 0"},
    {"limits.max_body_rate_rad_s", "0", "above 0"},
    {"limits.fence_max_ned_m", "[3, -99, 0.2]", "[1]: is -99, must be above fence_min_ned_m in y, -"},
    {"limits.min_height_m", "0", "above 0"},
    {"limits.min_height_m", "2.6", "is 2.6, must be at most the height of the fence, 2.5"},
    {"limits.fence_min_ned_m", "[-3, .nan, -2]", "[1]: is .nan, must be a finite number"},
    {"estimator.accelerometer_noise_m_s2_per_sqrt_hz", "0", "above 0"},
    {"estimator.gyro_noise_rad_s_per_sqrt_hz", "0", "above 0"},
    {"estimator.accelerometer_bias_walk_m_s2_per_sqrt_s", "-1", "at least 0"},
    {"estimator.gyro_bias_walk_rad_s_per_sqrt_s", "-1", "at least 0"},
    {"estimator.accelerometer_bias_m_s2", "-1", "at least 0"},
    {"estimator.gyro_bias_rad_s", "-1", "at least 0"},
    {"estimator.mocap_position_m", "0", "above 0"},
    {"estimator.mocap_orientation_rad", "0", "above 0"},
    {"estimator.gate_chi_square", "0", "above 0"},
    {"estimator.outlier_position_m", "0", "above 0"},
    {"estimator.outlier_orientation_rad", "0", "above 0"},
    {"estimator.accelerometer_bias_limit_m_s2", "-1", "at least 0"},
    {"estimator.gyro_bias_limit_rad_s", "-1", "at least 0"},
    {"estimator.max_speed_m_s", "0", "above 0"},
    {"estimator.max_body_rate_rad_s", "0", "above 0"},
    {"estimator.start_speed_m_s", "0", "above 0"},
    {"estimator.rotor_speed_bandwidth_rad_s", "0", "above 0"},
    {"estimator.detectors.stuck_pose.same", "0", "above 0"},
    {"estimator.detectors.stuck_pose.distinct", "1e-9", "at least 1e-08"},
    {"estimator.detectors.stuck_pose.distinct_poses", "0", "a whole number from 1 to"},
    {"estimator.detectors.stuck_pose.repetitions", "2.5", "a whole number"},
    {"estimator.detectors.continuity.noise_m", "-1", "at least 0"},
    {"estimator.detectors.continuity.noise_rad", "-1", "at least 0"},
    {"estimator.detectors.continuity.longest_gap_s", "0", "above 0"},
    {"estimator.detectors.continuity.lasting_s", "-1", "at least 0"},
    {"estimator.detectors.imu_silence.from_s", "0", "above 0"},
    {"estimator.detectors.imu_silence.longest_s", "0.01", "at least 0.02"},
    {"estimator.detectors.imu_silence.acceleration_m_s2", "-1", "at least 0"},
    {"estimator.detectors.imu_silence.body_rate_rad_s", "-1", "at least 0"},
    {"estimator.detectors.imu_silence.turn_rad", "-1", "at least 0"},
    {"estimator.detectors.imu_silence.turn_sigmas", "-1", "at least 0"},
    {"estimator.detectors.pose_imu_consistency.interval_s", "0", "above 0"},
    {"estimator.detectors.pose_imu_consistency.acceleration_m_s2", "-1", "at least 0"},
    {"estimator.detectors.pose_imu_consistency.turn_rad", "-1", "at least 0"},
    {"estimator.detectors.pose_imu_consistency.sigmas", "-1", "at least 0"},
    {"estimator.detectors.takeoff_consistency.memory_s", "0", "above 0"},
    {"estimator.detectors.takeoff_consistency.inertial_climb_m", "0", "above 0"},
    {"estimator.detectors.takeoff_consistency.min_pose_fraction", "2", "at most 1"},
    {"estimator.detectors.takeoff_consistency.confirmed_climb_m", "0", "above 0"},
    {"estimator.detectors.takeoff_consistency.longest_s", "-1", "at least 0"},
    {"estimator.detectors.recovery.longest_wait_s", "-1", "at least 0"},
    {"estimator.detectors.recovery.max_lead_s", "-1", "at least 0"},
    {"estimator.detectors.recovery.step_time_s", "0", "above 0"},
    {"estimator.detectors.recovery.sudden", "0.5", "at least 1"},
    {"estimator.detectors.recovery.swap_rad", "0", "above 0"},
    {"estimator.detectors.recovery.speed_m_s", "0", "above 0"},
    {"estimator.detectors.recovery.gyro_bias_rad_s", "0", "above 0"},
    {"estimator.detectors.recovery.accelerometer_bias_m_s2", "0", "above 0"},
    {"failsafe.mocap_timeout_s", "0", "above 0"},
    {"failsafe.descent_speed_m_s", "0", "above 0"},
    {"failsafe.descent_timeout_s", "0", "above 0"},
    {"failsafe.tip_over_tilt_rad", "0.1", "is 0.1, must be above limits.max_tilt_rad"},
    {"arming.max_tilt_rad", "0", "above 0"},
    {"arming.max_speed_m_s", "0", "above 0"},
    {"arming.max_body_rate_rad_s", "-1", "above 0"},
    {"arming.max_specific_force_error_m_s2", "0", "above 0"},
    {"arming.max_rotor_speed_rad_s", ".nan", "must be a finite number"},
    {"failsafe.imu_timeout_s", "0", "above 0"},
    {"failsafe.imu_gap_s", "0", "above 0"},
    {"failsafe.impact_m_s2", "9", "above 9.80665"},
    {"failsafe.low_battery_voltage_v", "-1", "at least 0"},
    {"failsafe.critical_battery_voltage_v", "3.4", "is 3.4, must be at least 0 and at most 3.3"},
    {"failsafe.battery_delay_s", "-1", "at least 0"},
    {"failsafe.battery_timeout_s", "0", "above 0"},
    {"failsafe.critical_descent_speed_m_s", "0", "above 0"},
    {"failsafe.fence_margin_m", "-0.1", "at least 0"},
    {"failsafe.ground_link_timeout_s", "0", "above 0"},
    {"failsafe.ground_link_action", "pray", "is pray, must be none, hold or land"},
    {"failsafe.setpoint_timeout_s", "soon", "is soon, must be a number"},
};

INSTANTIATE_TEST_SUITE_P(Control, SettingsFaults, testing::ValuesIn(kFaults));

}  // namespace swiftlet::io::control_settings_file_test
