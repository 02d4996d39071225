#include "swiftlet/plant/simulation/settings.hpp"

#include <cmath>

#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/simulation/wind_model.hpp"

namespace swiftlet::plant {

namespace {

double step_s(const SimulationSettings& settings) { return static_cast<double>(settings.step_ns) * 1.0e-9; }

// Samples are taken at the ends of integration steps only.
void check_whole_steps(const std::string& key, double rate_hz, const SimulationSettings& settings,
                       RuleChecker& check) {
  if (!(rate_hz > 0.0) || settings.step_ns <= 0) return;
  const double period = 1.0e9 / rate_hz;
  const std::int64_t rounded = period_ns(rate_hz);
  if (std::abs(period - static_cast<double>(rounded)) < 1.0e-6 * period && rounded % settings.step_ns == 0)
    return;
  check.add(key, "is ", rate_hz, ", must have a period that is a whole number of steps of ", step_s(settings),
            " s");
}

void check_axes(const std::string& key, const Eigen::Vector3d& value, double min, double max,
                RuleChecker& check) {
  for (int i = 0; i < 3; ++i) check.between(key + "[" + std::to_string(i) + "]", value[i], min, max);
}

// Gusts that change within a few steps would alternate in sign.
void check_dryden(const DrydenSettings& dryden, double step_s, RuleChecker& check) {
  constexpr double kLeastSteps = 10.0;
  const bool known = check.between("air.dryden.height_m", dryden.height_m, 0.0, 300.0) &&
                     check.between("air.dryden.airspeed_m_s", dryden.airspeed_m_s, 0.1, 50.0);
  if (!known || dryden.height_m == 0.0) return;
  const double time_s = dryden_times_s(dryden).minCoeff();
  if (time_s < kLeastSteps * step_s)
    check.add("air.dryden.height_m", "is ", dryden.height_m, ": turbulence of that size passes at ",
              dryden.airspeed_m_s, " m/s in ", time_s, " s, must take at least ", kLeastSteps, " steps of ",
              step_s, " s");
}

void check_navigation_sensors(const SimulationSettings& settings, RuleChecker& check) {
  const SiteSettings& site = settings.site;
  check.between("site.latitude_deg", site.latitude_deg, -89.0, 89.0);
  check.between("site.longitude_deg", site.longitude_deg, -180.0, 180.0);
  check.between("site.altitude_m", site.altitude_m, -500.0, 9000.0);
  check_axes("site.magnetic_field_ned_gauss", site.magnetic_field_ned, -1.0, 1.0, check);
  check.between("barometer.rate_hz", settings.barometer.rate_hz, 1.0, 1000.0);
  check.between("barometer.noise_pa", settings.barometer.noise_pa, 0.0, 1.0e3);
  check.between("barometer.bias_pa", settings.barometer.bias_sigma_pa, 0.0, 1.0e4);
  check.between("barometer.bias_walk_pa_per_sqrt_s", settings.barometer.bias_walk_pa, 0.0, 100.0);
  check.between("magnetometer.rate_hz", settings.magnetometer.rate_hz, 1.0, 1000.0);
  check.between("magnetometer.noise_gauss", settings.magnetometer.noise_gauss, 0.0, 1.0);
  check.between("magnetometer.bias_gauss", settings.magnetometer.bias_sigma_gauss, 0.0, 1.0);
  check.between("gps.rate_hz", settings.gps.rate_hz, 0.0, 1000.0);
  check_axes("gps.position_noise_ned_m", settings.gps.position_noise_ned, 0.0, 100.0, check);
  check_axes("gps.position_drift_ned_m", settings.gps.position_drift_ned, 0.0, 100.0, check);
  check.between("gps.drift_time_constant_s", settings.gps.drift_time_constant_s, 0.1, 1.0e4);
  check.between("odometry.position_drift_m", settings.odometry.position_drift_m, 0.0, 10.0);
  check.between("odometry.heading_drift_rad", settings.odometry.heading_drift_rad, 0.0, 1.0);
  check.between("odometry.drift_time_constant_s", settings.odometry.drift_time_constant_s, 1.0, 1.0e4);
  check_axes("gps.velocity_noise_ned_m_s", settings.gps.velocity_noise_ned, 0.0, 100.0, check);
}

}  // namespace

std::int64_t period_ns(double rate_hz) {
  return rate_hz > 0.0 ? std::llround(static_cast<double>(math::kSecond_ns) / rate_hz) : 0;
}

std::vector<Violation> validate(const SimulationSettings& settings) {
  RuleChecker check;
  check.between("step_s", step_s(settings), 1.0e-5, 1.0e-3);
  check.between("command_timeout_s", settings.command_timeout_s, 0.01, 10.0);
  check.between("command_hold_s", settings.command_hold_s, 0.01, 10.0);
  check.between("rotor_speed_rate_hz", settings.rotor_speed_rate_hz, 0.0, 2000.0);
  check_whole_steps("rotor_speed_rate_hz", settings.rotor_speed_rate_hz, settings, check);

  const ImuSettings& imu = settings.imu;
  check.between("imu.rate_hz", imu.rate_hz, 50.0, 8000.0);
  check_whole_steps("imu.rate_hz", imu.rate_hz, settings, check);
  check.between("imu.accelerometer_noise_m_s2_per_sqrt_hz", imu.accelerometer_noise_density, 0.0, 1.0);
  check.between("imu.gyro_noise_rad_s_per_sqrt_hz", imu.gyro_noise_density, 0.0, 1.0);
  check.between("imu.accelerometer_bias_m_s2", imu.accelerometer_bias_sigma, 0.0, 10.0);
  check.between("imu.gyro_bias_rad_s", imu.gyro_bias_sigma, 0.0, 1.0);
  check.between("imu.accelerometer_bias_walk_m_s2_per_sqrt_s", imu.accelerometer_bias_walk, 0.0, 1.0);
  check.between("imu.gyro_bias_walk_rad_s_per_sqrt_s", imu.gyro_bias_walk, 0.0, 1.0);
  check.between("imu.accelerometer_range_m_s2", imu.accelerometer_range, 20.0, 1.0e6);
  check.between("imu.gyro_range_rad_s", imu.gyro_range, 1.0, 1.0e6);

  const MocapSettings& mocap = settings.mocap;
  check.between("mocap.rate_hz", mocap.rate_hz, 1.0, 1000.0);
  double shortest = 1.0e-4;
  for (std::size_t i = 0; i < mocap.interval_quantiles_s.size(); ++i) {
    const std::string key = "mocap.interval_quantiles_s[" + std::to_string(i) + "]";
    if (!check.between(key, mocap.interval_quantiles_s[i], shortest, 10.0)) break;
    shortest = mocap.interval_quantiles_s[i];
  }
  check.between("mocap.latency_s", mocap.latency_s, 0.0, 1.0);
  check.between("mocap.position_error_m", mocap.position_error_m, 0.0, 1.0);
  check.between("mocap.orientation_error_rad", mocap.orientation_error_rad, 0.0, 0.5);
  check.between("mocap.misalignment_rad", mocap.misalignment_rad, 0.0, 0.5);
  check.between("mocap.dropout_probability", mocap.dropout_probability, 0.0, 1.0);
  check.between("mocap.dropout_length_s", mocap.dropout_length_s, 0.0, 60.0);

  check.between("radio.delay_s", settings.radio.delay_s, 0.0, 0.2);
  check.between("radio.jitter_s", settings.radio.jitter_s, 0.0, 0.2);
  check.between("radio.loss", settings.radio.loss, 0.0, 0.9);

  check.between("supply.initial_state_of_charge", settings.supply.initial_state_of_charge, 0.0, 1.0);
  check.between("supply.rate_hz", settings.supply.rate_hz, 1.0, 1000.0);
  check_whole_steps("supply.rate_hz", settings.supply.rate_hz, settings, check);

  check_axes("air.wind_ned_m_s", settings.air.wind_ned, -30.0, 30.0, check);
  check_axes("air.gust_sigma_ned_m_s", settings.air.gust_sigma_ned, 0.0, 10.0, check);
  check.between("air.gust_time_constant_s", settings.air.gust_time_constant_s, 0.01, 1000.0);
  check_dryden(settings.air.dryden, step_s(settings), check);
  check.between("air.rotor_drag_n_s2_per_m", settings.air.rotor_drag, 0.0, 1.0e-3);

  check.between("ground.leg_height_m", settings.ground.leg_height_m, 0.0, 1.0);
  check.between("ground.friction", settings.ground.friction, 0.0, 10.0);
  check.between("ground.effect_rotor_radius_m", settings.ground.effect_rotor_radius_m, 0.0, 1.0);

  check_navigation_sensors(settings, check);
  check_faults(settings.faults, step_s(settings), check);
  return check.take();
}

}  // namespace swiftlet::plant
