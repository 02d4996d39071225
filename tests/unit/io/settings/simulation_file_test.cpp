#include "swiftlet/io/settings/simulation_file.hpp"

#include <gtest/gtest.h>

#include "swiftlet/io/text_file.hpp"
#include "tests/support/paths.hpp"
#include "tests/unit/io/config_error_check.hpp"

namespace swiftlet::io::simulation_file_test {

using plant::SimulationSettings;
using tests::refusal;

std::string file(const std::string& name) {
  return read_text_file(tests::in_source("config/simulation/") + name + ".yaml");
}

// default.yaml with one text replaced.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = file("default");
  const std::size_t at = text.find(from);
  if (at == std::string::npos) {
    ADD_FAILURE() << from << " is not in the file";
    return text;
  }
  return text.replace(at, from.size(), to);
}

std::string refused(const std::string& from, const std::string& to) {
  return refusal([&] { parse_simulation_settings(changed(from, to), "s.yaml"); });
}

TEST(SimulationFile, DefaultFileMatchesTheStruct) {
  const SimulationSettings from_file = parse_simulation_settings(file("default"), "s.yaml");
  const SimulationSettings defaults;
  EXPECT_EQ(from_file.name, defaults.name);
  EXPECT_EQ(from_file.step_ns, defaults.step_ns);
  EXPECT_EQ(from_file.command_timeout_s, defaults.command_timeout_s);
  EXPECT_EQ(from_file.command_hold_s, defaults.command_hold_s);
  EXPECT_EQ(from_file.rotor_speed_rate_hz, defaults.rotor_speed_rate_hz);
  EXPECT_EQ(from_file.imu.rate_hz, defaults.imu.rate_hz);
  EXPECT_EQ(from_file.imu.accelerometer_noise_density, defaults.imu.accelerometer_noise_density);
  EXPECT_EQ(from_file.imu.gyro_noise_density, defaults.imu.gyro_noise_density);
  EXPECT_EQ(from_file.imu.accelerometer_bias_sigma, defaults.imu.accelerometer_bias_sigma);
  EXPECT_EQ(from_file.imu.gyro_bias_sigma, defaults.imu.gyro_bias_sigma);
  EXPECT_EQ(from_file.imu.accelerometer_bias_walk, defaults.imu.accelerometer_bias_walk);
  EXPECT_EQ(from_file.imu.gyro_bias_walk, defaults.imu.gyro_bias_walk);
  EXPECT_NEAR(from_file.imu.accelerometer_range, defaults.imu.accelerometer_range, 0.01);
  EXPECT_EQ(from_file.imu.gyro_range, defaults.imu.gyro_range);
  EXPECT_EQ(from_file.mocap.rate_hz, defaults.mocap.rate_hz);
  EXPECT_EQ(from_file.mocap.latency_s, defaults.mocap.latency_s);
  EXPECT_EQ(from_file.mocap.position_error_m, defaults.mocap.position_error_m);
  EXPECT_EQ(from_file.mocap.orientation_error_rad, defaults.mocap.orientation_error_rad);
  EXPECT_EQ(from_file.mocap.misalignment_rad, defaults.mocap.misalignment_rad);
  EXPECT_EQ(from_file.mocap.dropout_probability, defaults.mocap.dropout_probability);
  EXPECT_EQ(from_file.mocap.dropout_length_s, defaults.mocap.dropout_length_s);
  EXPECT_EQ(from_file.supply.ideal, defaults.supply.ideal);
  EXPECT_EQ(from_file.supply.initial_state_of_charge, defaults.supply.initial_state_of_charge);
  EXPECT_EQ(from_file.supply.rate_hz, defaults.supply.rate_hz);
  EXPECT_EQ(from_file.air.drag, defaults.air.drag);
  EXPECT_EQ(from_file.air.wind_ned, defaults.air.wind_ned);
  EXPECT_EQ(from_file.air.gust_sigma_ned, defaults.air.gust_sigma_ned);
  EXPECT_EQ(from_file.air.gust_time_constant_s, defaults.air.gust_time_constant_s);
  EXPECT_EQ(from_file.ground.present, defaults.ground.present);
  EXPECT_EQ(from_file.ground.leg_height_m, defaults.ground.leg_height_m);
  EXPECT_EQ(from_file.ground.friction, defaults.ground.friction);
  EXPECT_EQ(from_file.site.latitude_deg, defaults.site.latitude_deg);
  EXPECT_EQ(from_file.site.longitude_deg, defaults.site.longitude_deg);
  EXPECT_EQ(from_file.site.altitude_m, defaults.site.altitude_m);
  EXPECT_EQ(from_file.site.magnetic_field_ned, defaults.site.magnetic_field_ned);
  EXPECT_EQ(from_file.barometer.rate_hz, defaults.barometer.rate_hz);
  EXPECT_EQ(from_file.barometer.noise_pa, defaults.barometer.noise_pa);
  EXPECT_EQ(from_file.barometer.bias_sigma_pa, defaults.barometer.bias_sigma_pa);
  EXPECT_EQ(from_file.barometer.bias_walk_pa, defaults.barometer.bias_walk_pa);
  EXPECT_EQ(from_file.magnetometer.rate_hz, defaults.magnetometer.rate_hz);
  EXPECT_EQ(from_file.magnetometer.noise_gauss, defaults.magnetometer.noise_gauss);
  EXPECT_EQ(from_file.magnetometer.bias_sigma_gauss, defaults.magnetometer.bias_sigma_gauss);
  EXPECT_EQ(from_file.gps.rate_hz, defaults.gps.rate_hz);
  EXPECT_EQ(from_file.gps.position_noise_ned, defaults.gps.position_noise_ned);
  EXPECT_EQ(from_file.gps.position_drift_ned, defaults.gps.position_drift_ned);
  EXPECT_EQ(from_file.gps.drift_time_constant_s, defaults.gps.drift_time_constant_s);
  EXPECT_EQ(from_file.gps.velocity_noise_ned, defaults.gps.velocity_noise_ned);
}

TEST(SimulationFile, OptitrackSamplesItsIntervals) {
  const SimulationSettings s = parse_simulation_settings(file("optitrack"), "s.yaml");
  EXPECT_EQ(s.name, "optitrack");
  EXPECT_EQ(s.mocap.model, plant::MocapModel::kOptitrack);
  EXPECT_EQ(s.mocap.interval_quantiles_s, plant::MocapSettings().interval_quantiles_s);
  std::string text = file("optitrack");
  const std::string falls = "0.0400, 0.1300";
  text.replace(text.find(falls), falls.size(), "0.1300, 0.0400");
  EXPECT_NE(refusal([&] { parse_simulation_settings(text, "s.yaml"); }).find("interval_quantiles_s[9]"),
            std::string::npos);
}

TEST(SimulationFile, IdealHasNoErrors) {
  const SimulationSettings s = parse_simulation_settings(file("ideal"), "s.yaml");
  EXPECT_EQ(s.name, "ideal");
  for (const double error :
       {s.imu.accelerometer_noise_density, s.imu.gyro_noise_density, s.imu.accelerometer_bias_sigma,
        s.imu.gyro_bias_sigma, s.imu.accelerometer_bias_walk, s.imu.gyro_bias_walk, s.mocap.latency_s,
        s.mocap.position_error_m, s.mocap.orientation_error_rad, s.mocap.misalignment_rad,
        s.mocap.dropout_probability, s.barometer.noise_pa, s.barometer.bias_sigma_pa,
        s.barometer.bias_walk_pa, s.magnetometer.noise_gauss, s.magnetometer.bias_sigma_gauss,
        s.gps.position_noise_ned.norm(), s.gps.position_drift_ned.norm(), s.gps.velocity_noise_ned.norm()}) {
    EXPECT_EQ(error, 0.0);
  }
  EXPECT_TRUE(s.supply.ideal);
  EXPECT_FALSE(s.air.drag);
  EXPECT_TRUE(s.air.wind_ned.isZero(0.0));
  EXPECT_TRUE(s.air.gust_sigma_ned.isZero(0.0));
}

TEST(SimulationFile, RoughAirIsOptional) {
  std::string text = file("default");
  const SimulationSettings without = parse_simulation_settings(text, "s.yaml");
  EXPECT_EQ(without.air.dryden.height_m, 0.0);
  EXPECT_EQ(without.air.rotor_drag, 0.0);
  EXPECT_EQ(without.ground.effect_rotor_radius_m, 0.0);
  const std::string air = "  gust_time_constant_s: 1\n";
  text.replace(text.find(air), air.size(),
               air + "  dryden: {height_m: 1.5, airspeed_m_s: 2.2}\n  rotor_drag_n_s2_per_m: 9.18e-7\n");
  const std::string ground = "  friction: 0.6\n";
  text.replace(text.find(ground), ground.size(), ground + "  effect_rotor_radius_m: 0.03\n");
  const SimulationSettings with = parse_simulation_settings(text, "s.yaml");
  EXPECT_EQ(with.air.dryden.height_m, 1.5);
  EXPECT_EQ(with.air.dryden.airspeed_m_s, 2.2);
  EXPECT_EQ(with.air.rotor_drag, 9.18e-7);
  EXPECT_EQ(with.ground.effect_rotor_radius_m, 0.03);
  text.replace(text.find("airspeed_m_s: 2.2"), 17, "airspeed_m_s: 0.0");
  EXPECT_NE(refusal([&] { parse_simulation_settings(text, "s.yaml"); }).find("air.dryden.airspeed_m_s"),
            std::string::npos);
}

TEST(SimulationFile, RefusesValuesOutOfRange) {
  EXPECT_EQ(refused("  friction: 0.6", "  friction: -1"),
            "s.yaml:51: ground.friction: is -1, must be at least 0 and at most 10");
  EXPECT_EQ(refused("altitude_m: 488", "altitude_m: 9999"),
            "s.yaml:58: site.altitude_m: is 9999, must be at least -500 and at most 9000");
  EXPECT_EQ(refused("position_drift_ned_m: [0.3, 0.3, 0.6]", "position_drift_ned_m: [0.3, -1, 0.6]"),
            "s.yaml:75: gps.position_drift_ned_m[1]: is -1, must be at least 0 and at most 100");
  EXPECT_EQ(refused("rate_hz: 500  #", "rate_hz: 400  #"),
            "s.yaml:15: imu.rate_hz: is 400, must have a period that is a whole number of steps of 0.001 s");
  EXPECT_EQ(refused("wind_ned_m_s: [0, 0, 0]", "wind_ned_m_s: [0, 99, 0]"),
            "s.yaml:43: air.wind_ned_m_s[1]: is 99, must be at least -30 and at most 30");
}

TEST(SimulationFile, RefusesUnknownKeysAndInvalidValues) {
  EXPECT_NE(refused("  drag:", "  drug:").find("air.drug: is unknown, must be one of drag"),
            std::string::npos);
  EXPECT_NE(refused("  drag: true", "  drag: true\n  lift: 1").find("s.yaml:43: air.lift: "),
            std::string::npos);
  EXPECT_NE(refused("  latency_s: 0.010", "  latency_s: soon").find("s.yaml:29: mocap.latency_s: is soon"),
            std::string::npos);
  EXPECT_NE(refused("  latency_s: 0.010", "  latency_s: .nan").find("s.yaml:29: mocap.latency_s: "),
            std::string::npos);
  EXPECT_NE(refused("step_s: 0.001", "step_s: 7").find("s.yaml:5: step_s: is 7"), std::string::npos);
}

std::string with_faults(const std::string& faults) { return file("default") + "faults:\n" + faults; }

std::string refused_faults(const std::string& faults) {
  return refusal([&] { parse_simulation_settings(with_faults(faults), "s.yaml"); });
}

TEST(SimulationFile, ReadsFaultsOfEveryKind) {
  EXPECT_TRUE(parse_simulation_settings(file("default"), "s.yaml").faults.empty());
  const SimulationSettings s = parse_simulation_settings(
      with_faults(
          "  - {kind: mocap_stop, at_s: 1, for_s: 0.5}\n"
          "  - {kind: mocap_freeze, at_s: 1, for_s: 0.5}\n"
          "  - {kind: mocap_untracked, at_s: 1, for_s: 0.5}\n"
          "  - {kind: mocap_jump, at_s: 1, for_s: 0.5, position_ned_m: [1, 2, 3], rotation_frd_rad: [0, 0, "
          "3]}\n"
          "  - {kind: mocap_swap, at_s: 1, for_s: 0.5, position_ned_m: [1, 2, 3], yaw_rad: 0.5}\n"
          "  - {kind: mocap_latency, at_s: 1, for_s: 0.5, delay_s: 0.1}\n"
          "  - {kind: imu_stop, at_s: 1, for_s: 0.5}\n"
          "  - {kind: imu_nan, at_s: 1, for_s: 0.5}\n"
          "  - {kind: imu_stuck, at_s: 1, for_s: 0.5}\n"
          "  - {kind: imu_bias, at_s: 1, for_s: 0.5, accelerometer_m_s2: [1, 2, 3], gyro_rad_s: [4, 5, 6]}\n"
          "  - {kind: battery_stop, at_s: 1, for_s: 0.5}\n"
          "  - {kind: rotor_speeds_stop, at_s: 1, for_s: 0.5}\n"
          "  - {kind: battery_drop, at_s: 1, for_s: 0.5, voltage_v: 0.25}\n"
          "  - {kind: rotor_thrust, at_s: 1, for_s: 0.5, rotor: 3, factor: 0.75}\n"
          "  - {kind: push, at_s: 1, for_s: 0.5, force_ned_n: [1, 2, 3], moment_frd_n_m: [4, 5, 6]}\n"
          "  - {kind: wind, at_s: 1, for_s: 0.5, wind_ned_m_s: [1, 2, 3]}\n"
          "  - {kind: commands_stop, at_s: 1, for_s: 0.5}\n"
          "  - {kind: commands_delay, at_s: 1, for_s: 0.5, delay_s: 0.05}\n"
          "  - {kind: odometry_jump, at_s: 1, for_s: 0.5, position_ned_m: [1, 2, 3], yaw_rad: 0.25}\n"),
      "s.yaml");
  ASSERT_EQ(s.faults.size(), plant::kFaultKinds);
  for (std::size_t i = 0; i < s.faults.size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(s.faults[i].kind), i);
    EXPECT_EQ(s.faults[i].at_s, 1.0);
    EXPECT_EQ(s.faults[i].for_s, 0.5);
  }
  EXPECT_EQ(s.faults[3].position_ned, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(s.faults[3].rotation_frd, Eigen::Vector3d(0, 0, 3));
  EXPECT_EQ(s.faults[4].position_ned, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(s.faults[4].yaw_rad, 0.5);
  EXPECT_EQ(s.faults[5].delay_s, 0.1);
  EXPECT_EQ(s.faults[9].specific_force_frd, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(s.faults[9].body_rates_frd, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(s.faults[12].voltage_v, 0.25);
  EXPECT_EQ(s.faults[13].rotor, 3);
  EXPECT_EQ(s.faults[13].factor, 0.75);
  EXPECT_EQ(s.faults[14].force_ned, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(s.faults[14].moment_frd, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(s.faults[15].wind_ned, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(s.faults[17].delay_s, 0.05);
  EXPECT_EQ(s.faults[18].position_ned, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(s.faults[18].yaw_rad, 0.25);
}

TEST(SimulationFile, RefusesInvalidFaults) {
  EXPECT_EQ(refused_faults("  - {kind: imu_stop, at_s: -1, for_s: 1}\n"),
            "s.yaml:85: faults[0].at_s: is -1, must be at least 0 and at most 86400");
  EXPECT_NE(refused_faults("  - {kind: imu_stopped, at_s: 1, for_s: 1}\n")
                .find("s.yaml:85: faults[0].kind: is imu_stopped, must be "),
            std::string::npos);
  EXPECT_NE(refused_faults("  - {kind: mocap_latency, at_s: 1, for_s: 1}\n").find("faults[0].delay_s"),
            std::string::npos);
  EXPECT_NE(refused_faults("  - {kind: imu_stop, at_s: 1, for_s: 1, delay_s: 1}\n").find("faults[0].delay_s"),
            std::string::npos);
  EXPECT_EQ(
      refused_faults("  - {kind: imu_stop, at_s: 1, for_s: 1}\n"
                     "  - {kind: imu_stop, at_s: 1.5, for_s: 1}\n"),
      "s.yaml:86: faults[1].at_s: is 1.5, but faults[0], imu_stop too, lasts from 1 s to 2 s: faults of "
      "one kind must not overlap");
}

TEST(SimulationFile, FaultsExampleExtendsTheDefault) {
  const std::string example = file("faults_example");
  EXPECT_GT(parse_simulation_settings(example, "s.yaml").faults.size(), 10U);
  const std::string world = file("default");
  const std::string settings = world.substr(world.find("step_s:"));
  EXPECT_NE(example.find(settings), std::string::npos);
}

TEST(SimulationFile, ReadsARadio) {
  EXPECT_FALSE(parse_simulation_settings(file("default"), "s.yaml").radio.on());
  const std::string radio = "\nradio: {delay_s: 0.02, jitter_s: 0.004, loss: 0.03}\n";
  const SimulationSettings settings = parse_simulation_settings(file("default") + radio, "s.yaml");
  EXPECT_EQ(settings.radio.delay_s, 0.02);
  EXPECT_EQ(settings.radio.jitter_s, 0.004);
  EXPECT_EQ(settings.radio.loss, 0.03);
  EXPECT_NE(refusal([] {
              parse_simulation_settings(file("default") + "\nradio: {delay_s: 1, jitter_s: 0, loss: 0}\n",
                                        "s.yaml");
            }).find("radio.delay_s: is 1, must be at least 0 and at most 0.2"),
            std::string::npos);
}

TEST(SimulationFile, NamesAMissingFile) {
  EXPECT_NE(refusal([] { load_simulation_settings("/nowhere/s.yaml"); }).find("/nowhere/s.yaml: "),
            std::string::npos);
}

}  // namespace swiftlet::io::simulation_file_test
