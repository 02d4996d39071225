#include "swiftlet/plant/simulation/settings.hpp"

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::tests::settings_test {

using plant::SimulationSettings;

TEST(SimulationSettings, DefaultsAreValid) { EXPECT_TRUE(plant::validate(SimulationSettings()).empty()); }

struct Rule {
  const char* key;
  std::function<void(SimulationSettings&, double)> set;
  double min;
  double max;
};

const std::vector<Rule>& rules() {
  using S = SimulationSettings;
  static const std::vector<Rule> all = {
      {"command_timeout_s", [](S& s, double v) { s.command_timeout_s = v; }, 0.01, 10.0},
      {"radio.delay_s", [](S& s, double v) { s.radio.delay_s = v; }, 0.0, 0.2},
      {"radio.jitter_s", [](S& s, double v) { s.radio.jitter_s = v; }, 0.0, 0.2},
      {"radio.loss", [](S& s, double v) { s.radio.loss = v; }, 0.0, 0.9},
      {"command_hold_s", [](S& s, double v) { s.command_hold_s = v; }, 0.01, 10.0},
      {"rotor_speed_rate_hz", [](S& s, double v) { s.rotor_speed_rate_hz = v; }, 0.0, 2000.0},
      {"imu.rate_hz", [](S& s, double v) { s.imu.rate_hz = v; }, 50.0, 8000.0},
      {"imu.accelerometer_noise_m_s2_per_sqrt_hz",
       [](S& s, double v) { s.imu.accelerometer_noise_density = v; }, 0.0, 1.0},
      {"imu.gyro_noise_rad_s_per_sqrt_hz", [](S& s, double v) { s.imu.gyro_noise_density = v; }, 0.0, 1.0},
      {"imu.accelerometer_bias_m_s2", [](S& s, double v) { s.imu.accelerometer_bias_sigma = v; }, 0.0, 10.0},
      {"imu.gyro_bias_rad_s", [](S& s, double v) { s.imu.gyro_bias_sigma = v; }, 0.0, 1.0},
      {"imu.accelerometer_bias_walk_m_s2_per_sqrt_s",
       [](S& s, double v) { s.imu.accelerometer_bias_walk = v; }, 0.0, 1.0},
      {"imu.gyro_bias_walk_rad_s_per_sqrt_s", [](S& s, double v) { s.imu.gyro_bias_walk = v; }, 0.0, 1.0},
      {"imu.accelerometer_range_m_s2", [](S& s, double v) { s.imu.accelerometer_range = v; }, 20.0, 1.0e6},
      {"imu.gyro_range_rad_s", [](S& s, double v) { s.imu.gyro_range = v; }, 1.0, 1.0e6},
      {"mocap.rate_hz", [](S& s, double v) { s.mocap.rate_hz = v; }, 1.0, 1000.0},
      {"mocap.latency_s", [](S& s, double v) { s.mocap.latency_s = v; }, 0.0, 1.0},
      {"mocap.position_error_m", [](S& s, double v) { s.mocap.position_error_m = v; }, 0.0, 1.0},
      {"mocap.orientation_error_rad", [](S& s, double v) { s.mocap.orientation_error_rad = v; }, 0.0, 0.5},
      {"mocap.misalignment_rad", [](S& s, double v) { s.mocap.misalignment_rad = v; }, 0.0, 0.5},
      {"mocap.dropout_probability", [](S& s, double v) { s.mocap.dropout_probability = v; }, 0.0, 1.0},
      {"mocap.dropout_length_s", [](S& s, double v) { s.mocap.dropout_length_s = v; }, 0.0, 60.0},
      {"supply.initial_state_of_charge", [](S& s, double v) { s.supply.initial_state_of_charge = v; }, 0.0,
       1.0},
      {"supply.rate_hz", [](S& s, double v) { s.supply.rate_hz = v; }, 1.0, 1000.0},
      {"air.wind_ned_m_s[1]", [](S& s, double v) { s.air.wind_ned[1] = v; }, -30.0, 30.0},
      {"air.gust_sigma_ned_m_s[2]", [](S& s, double v) { s.air.gust_sigma_ned[2] = v; }, 0.0, 10.0},
      {"air.gust_time_constant_s", [](S& s, double v) { s.air.gust_time_constant_s = v; }, 0.01, 1000.0},
      {"ground.leg_height_m", [](S& s, double v) { s.ground.leg_height_m = v; }, 0.0, 1.0},
      {"ground.friction", [](S& s, double v) { s.ground.friction = v; }, 0.0, 10.0},
      {"site.latitude_deg", [](S& s, double v) { s.site.latitude_deg = v; }, -89.0, 89.0},
      {"site.longitude_deg", [](S& s, double v) { s.site.longitude_deg = v; }, -180.0, 180.0},
      {"site.altitude_m", [](S& s, double v) { s.site.altitude_m = v; }, -500.0, 9000.0},
      {"site.magnetic_field_ned_gauss[0]", [](S& s, double v) { s.site.magnetic_field_ned[0] = v; }, -1.0,
       1.0},
      {"barometer.rate_hz", [](S& s, double v) { s.barometer.rate_hz = v; }, 1.0, 1000.0},
      {"barometer.noise_pa", [](S& s, double v) { s.barometer.noise_pa = v; }, 0.0, 1.0e3},
      {"barometer.bias_pa", [](S& s, double v) { s.barometer.bias_sigma_pa = v; }, 0.0, 1.0e4},
      {"barometer.bias_walk_pa_per_sqrt_s", [](S& s, double v) { s.barometer.bias_walk_pa = v; }, 0.0, 100.0},
      {"magnetometer.rate_hz", [](S& s, double v) { s.magnetometer.rate_hz = v; }, 1.0, 1000.0},
      {"magnetometer.noise_gauss", [](S& s, double v) { s.magnetometer.noise_gauss = v; }, 0.0, 1.0},
      {"magnetometer.bias_gauss", [](S& s, double v) { s.magnetometer.bias_sigma_gauss = v; }, 0.0, 1.0},
      {"gps.rate_hz", [](S& s, double v) { s.gps.rate_hz = v; }, 0.0, 1000.0},
      {"gps.position_noise_ned_m[0]", [](S& s, double v) { s.gps.position_noise_ned[0] = v; }, 0.0, 100.0},
      {"gps.position_drift_ned_m[1]", [](S& s, double v) { s.gps.position_drift_ned[1] = v; }, 0.0, 100.0},
      {"gps.drift_time_constant_s", [](S& s, double v) { s.gps.drift_time_constant_s = v; }, 0.1, 1.0e4},
      {"gps.velocity_noise_ned_m_s[2]", [](S& s, double v) { s.gps.velocity_noise_ned[2] = v; }, 0.0, 100.0},
  };
  return all;
}

// Keys that are out of range, without the rule of whole steps.
std::vector<std::string> out_of_range(const SimulationSettings& settings) {
  std::vector<std::string> keys;
  for (const plant::Violation& violation : plant::validate(settings)) {
    if (violation.message.find("must be at least") != std::string::npos) keys.push_back(violation.key);
  }
  return keys;
}

TEST(SimulationSettings, ChecksTheRangeOfEveryNumber) {
  for (const Rule& rule : rules()) {
    SCOPED_TRACE(rule.key);
    SimulationSettings settings;
    settings.step_ns = 125'000;  // divides the periods of both ends of every rate
    for (const double good : {rule.min, rule.max}) {
      rule.set(settings, good);
      EXPECT_TRUE(plant::validate(settings).empty()) << good;
    }
    const double slack = 1.0e-6 * (1.0 + rule.max);
    for (const double bad : {rule.min - slack, rule.max + slack, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
      rule.set(settings, bad);
      EXPECT_EQ(out_of_range(settings), std::vector<std::string>{rule.key}) << bad;
    }
  }
}

// GIVEN Dryden gusts that change faster than the steps follow THEN they are refused, and 10 steps are enough.
TEST(SimulationSettings, ChecksTheTimeInWhichDrydenGustsChange) {
  SimulationSettings settings;
  settings.step_ns = 1'000'000;
  settings.air.dryden = {0.01, 50.0};
  const std::vector<plant::Violation> violations = plant::validate(settings);
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations.front().key, "air.dryden.height_m");
  EXPECT_EQ(violations.front().message,
            "is 0.01: turbulence of that size passes at 50 m/s in 0.0002 s, must take at least 10 steps of "
            "0.001 s");
  settings.air.dryden = {0.51, 50.0};
  EXPECT_TRUE(plant::validate(settings).empty());
  settings.air.dryden = {0.0, 50.0};
  EXPECT_TRUE(plant::validate(settings).empty()) << "without Dryden gusts";
}

TEST(SimulationSettings, ChecksTheRangeOfTheStep) {
  for (const std::int64_t step_ns : {0, -1'000'000, 9'000, 2'000'000}) {
    SimulationSettings settings;
    settings.step_ns = step_ns;
    EXPECT_EQ(out_of_range(settings), std::vector<std::string>{"step_s"}) << step_ns;
  }
}

TEST(SimulationSettings, RequiresSamplePeriodsOfWholeSteps) {
  SimulationSettings settings;
  settings.imu.rate_hz = 400.0;  // 2.5 ms
  settings.rotor_speed_rate_hz = 300.0;
  settings.supply.rate_hz = 7.0;
  const std::vector<plant::Violation> violations = plant::validate(settings);
  ASSERT_EQ(violations.size(), 3U);
  EXPECT_EQ(violations[0].key, "rotor_speed_rate_hz");
  EXPECT_EQ(violations[1].key, "imu.rate_hz");
  EXPECT_EQ(violations[1].message, "is 400, must have a period that is a whole number of steps of 0.001 s");
  EXPECT_EQ(violations[2].key, "supply.rate_hz");
  settings = {};
  settings.imu.rate_hz = 400.0;
  settings.step_ns = 500'000;
  EXPECT_TRUE(plant::validate(settings).empty());
}

}  // namespace swiftlet::tests::settings_test
