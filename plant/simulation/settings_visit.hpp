// Visits of the settings of the simulation (plant/model/setting.hpp): keys of the simulation file, units, limits, meanings.
// By hand: `name`, `step_s`, the faults, and the rules between several settings in validate().
#pragma once

#include "swiftlet/plant/model/setting.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

template <class Visitor>
void visit(ImuSettings& s, Visitor& v) {
  v({"rate_hz", "Hz", between(50.0, 8000.0)}, s.rate_hz);
  v({{"accelerometer_noise_density", "accelerometer_noise_m_s2_per_sqrt_hz"},
     "m/s^2/sqrt(Hz)",
     between(0.0, 1.0)},
    s.accelerometer_noise_density);
  v({{"gyro_noise_density", "gyro_noise_rad_s_per_sqrt_hz"}, "rad/s/sqrt(Hz)", between(0.0, 1.0)},
    s.gyro_noise_density);
  v({{"accelerometer_bias_sigma", "accelerometer_bias_m_s2"}, "m/s^2", between(0.0, 10.0), "once per run"},
    s.accelerometer_bias_sigma);
  v({{"gyro_bias_sigma", "gyro_bias_rad_s"}, "rad/s", between(0.0, 1.0), "once per run"}, s.gyro_bias_sigma);
  v({{"accelerometer_bias_walk", "accelerometer_bias_walk_m_s2_per_sqrt_s"},
     "m/s^2/sqrt(s)",
     between(0.0, 1.0)},
    s.accelerometer_bias_walk);
  v({{"gyro_bias_walk", "gyro_bias_walk_rad_s_per_sqrt_s"}, "rad/s/sqrt(s)", between(0.0, 1.0)},
    s.gyro_bias_walk);
  v({{"accelerometer_range", "accelerometer_range_m_s2"}, "m/s^2", between(20.0, 1.0e6)},
    s.accelerometer_range);
  v({{"gyro_range", "gyro_range_rad_s"}, "rad/s", between(1.0, 1.0e6)}, s.gyro_range);
}

template <class Visitor>
void visit(MocapSettings& s, Visitor& v) {
  v({"model"}, s.model, {"bounded", "optitrack"});
  const bool bounded = s.model == MocapModel::kBounded;
  v({"rate_hz", "Hz", between(1.0, 1000.0), "of model bounded",
     bounded ? InFile::kRequired : InFile::kAbsent},
    s.rate_hz);
  v({"interval_quantiles_s",
     "s",
     {},
     "of the frame interval of model optitrack",
     bounded ? InFile::kAbsent : InFile::kRequired},
    s.interval_quantiles_s);
  v({"latency_s", "s", between(0.0, 1.0), "from exposure to delivery"}, s.latency_s);
  v({"position_error_m", "m", between(0.0, 1.0)}, s.position_error_m);
  v({"orientation_error_rad", "rad", between(0.0, 0.5)}, s.orientation_error_rad);
  v({"misalignment_rad", "rad", between(0.0, 0.5)}, s.misalignment_rad);
  v({"dropout_probability", "1", between(0.0, 1.0), "of a frame"}, s.dropout_probability);
  v({"dropout_length_s", "s", between(0.0, 60.0)}, s.dropout_length_s);
}

template <class Visitor>
void visit(RadioSettings& s, Visitor& v) {
  v({"delay_s", "s", between(0.0, 0.2)}, s.delay_s);
  v({"jitter_s", "s", between(0.0, 0.2), "at most, in addition"}, s.jitter_s);
  v({"loss", "1", between(0.0, 0.9), "probability that a packet is lost"}, s.loss);
}

template <class Visitor>
void visit(SupplySettings& s, Visitor& v) {
  v({"ideal", "true: the voltage is constant"}, s.ideal);
  v({"initial_state_of_charge", "1", between(0.0, 1.0), "0 .. 1"}, s.initial_state_of_charge);
  v({"rate_hz", "Hz", between(1.0, 1000.0), "of battery samples"}, s.rate_hz);
}

template <class Visitor>
void visit(DrydenSettings& s, Visitor& v) {
  v({"height_m", "m", between(0.0, 300.0), "0: gusts of the first order"}, s.height_m);
  v({"airspeed_m_s", "m/s", between(0.1, 50.0)}, s.airspeed_m_s);
}

template <class Visitor>
void visit(AirSettings& s, Visitor& v) {
  v({"drag", "true: the linear drag of the vehicle applies"}, s.drag);
  v({{"wind_ned", "wind_ned_m_s"}, "m/s", between(-30.0, 30.0)}, s.wind_ned);
  v({{"gust_sigma_ned", "gust_sigma_ned_m_s"}, "m/s", between(0.0, 10.0)}, s.gust_sigma_ned);
  v({"gust_time_constant_s", "s", between(0.01, 1000.0)}, s.gust_time_constant_s);
  v({"dryden", "gusts by the Dryden model", InFile::kOptional}, s.dryden);
  v({{"rotor_drag", "rotor_drag_n_s2_per_m"}, "N*s^2/m", between(0.0, 1.0e-3), "", InFile::kOptional},
    s.rotor_drag);
}

template <class Visitor>
void visit(GroundSettings& s, Visitor& v) {
  v({"present"}, s.present);
  v({"leg_height_m", "m", between(0.0, 1.0)}, s.leg_height_m);
  v({"friction", "1", between(0.0, 10.0)}, s.friction);
  v({"effect_rotor_radius_m", "m", between(0.0, 1.0), "0: no ground effect", InFile::kOptional},
    s.effect_rotor_radius_m);
}

template <class Visitor>
void visit(SiteSettings& s, Visitor& v) {
  v({"latitude_deg", "deg", between(-89.0, 89.0)}, s.latitude_deg);
  v({"longitude_deg", "deg", between(-180.0, 180.0)}, s.longitude_deg);
  v({"altitude_m", "m", between(-500.0, 9000.0), "above mean sea level"}, s.altitude_m);
  v({{"magnetic_field_ned", "magnetic_field_ned_gauss"}, "gauss", between(-1.0, 1.0)}, s.magnetic_field_ned);
}

template <class Visitor>
void visit(BarometerSettings& s, Visitor& v) {
  v({"rate_hz", "Hz", between(1.0, 1000.0)}, s.rate_hz);
  v({"noise_pa", "Pa", between(0.0, 1.0e3)}, s.noise_pa);
  v({{"bias_sigma_pa", "bias_pa"}, "Pa", between(0.0, 1.0e4), "once per run"}, s.bias_sigma_pa);
  v({{"bias_walk_pa", "bias_walk_pa_per_sqrt_s"}, "Pa/sqrt(s)", between(0.0, 100.0)}, s.bias_walk_pa);
}

template <class Visitor>
void visit(MagnetometerSettings& s, Visitor& v) {
  v({"rate_hz", "Hz", between(1.0, 1000.0)}, s.rate_hz);
  v({"noise_gauss", "gauss", between(0.0, 1.0)}, s.noise_gauss);
  v({{"bias_sigma_gauss", "bias_gauss"}, "gauss", between(0.0, 1.0), "once per run"}, s.bias_sigma_gauss);
}

template <class Visitor>
void visit(GpsSettings& s, Visitor& v) {
  v({"rate_hz", "Hz", between(0.0, 1000.0), "0: none"}, s.rate_hz);
  v({{"position_noise_ned", "position_noise_ned_m"}, "m", between(0.0, 100.0)}, s.position_noise_ned);
  v({{"position_drift_ned", "position_drift_ned_m"}, "m", between(0.0, 100.0)}, s.position_drift_ned);
  v({"drift_time_constant_s", "s", between(0.1, 1.0e4)}, s.drift_time_constant_s);
  v({{"velocity_noise_ned", "velocity_noise_ned_m_s"}, "m/s", between(0.0, 100.0)}, s.velocity_noise_ned);
}

template <class Visitor>
void visit(OdometrySettings& s, Visitor& v) {
  v({"position_drift_m", "m", between(0.0, 10.0), "of each axis"}, s.position_drift_m);
  v({"heading_drift_rad", "rad", between(0.0, 1.0)}, s.heading_drift_rad);
  v({"drift_time_constant_s", "s", between(1.0, 1.0e4)}, s.drift_time_constant_s);
}

template <class Visitor>
void visit(SimulationSettings& s, Visitor& v) {
  v({"command_timeout_s", "s", between(0.01, 10.0)}, s.command_timeout_s);
  v({"command_hold_s", "s", between(0.01, 10.0), "", InFile::kOptional}, s.command_hold_s);
  v({"rotor_speed_rate_hz", "Hz", between(0.0, 2000.0), "0: not measured"}, s.rotor_speed_rate_hz);
  v({"imu", "noise densities as of data sheets"}, s.imu);
  v({"mocap", "motion capture"}, s.mocap);
  v({"radio", "between vehicle and ground, each way", InFile::kOptional}, s.radio);
  v({"supply", "the battery in the simulation"}, s.supply);
  v({"air", "drag, wind and gusts"}, s.air);
  v({"ground", "the floor"}, s.ground);
  v(Setting{"site", "the place of the origin on Earth"}.fixed(), s.site);
  v(Setting{"barometer", "of an autopilot"}.fixed(), s.barometer);
  v(Setting{"magnetometer", "of an autopilot"}.fixed(), s.magnetometer);
  v(Setting{"gps", "of an autopilot"}.fixed(), s.gps);
  v({"odometry", "position sensors of the vehicle's own", InFile::kOptional}, s.odometry);
}

}  // namespace swiftlet::plant
