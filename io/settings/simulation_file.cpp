#include "swiftlet/io/settings/simulation_file.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "swiftlet/io/config.hpp"
#include "swiftlet/io/settings/violations.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {

namespace {

plant::ImuSettings read_imu(const ConfigNode& node) {
  plant::ImuSettings imu;
  imu.rate_hz = node.at("rate_hz").number();
  imu.accelerometer_noise_density = node.at("accelerometer_noise_m_s2_per_sqrt_hz").number();
  imu.gyro_noise_density = node.at("gyro_noise_rad_s_per_sqrt_hz").number();
  imu.accelerometer_bias_sigma = node.at("accelerometer_bias_m_s2").number();
  imu.gyro_bias_sigma = node.at("gyro_bias_rad_s").number();
  imu.accelerometer_bias_walk = node.at("accelerometer_bias_walk_m_s2_per_sqrt_s").number();
  imu.gyro_bias_walk = node.at("gyro_bias_walk_rad_s_per_sqrt_s").number();
  imu.accelerometer_range = node.at("accelerometer_range_m_s2").number();
  imu.gyro_range = node.at("gyro_range_rad_s").number();
  return imu;
}

plant::MocapSettings read_mocap(const ConfigNode& node) {
  plant::MocapSettings mocap;
  mocap.model = node.at("model").choice<plant::MocapModel>(
      {{"bounded", plant::MocapModel::kBounded}, {"optitrack", plant::MocapModel::kOptitrack}});
  if (mocap.model == plant::MocapModel::kBounded) {
    mocap.rate_hz = node.at("rate_hz").number();
  } else {
    const std::size_t count = mocap.interval_quantiles_s.size();
    const std::vector<double> quantiles = node.at("interval_quantiles_s").numbers(count, count);
    std::copy(quantiles.begin(), quantiles.end(), mocap.interval_quantiles_s.begin());
  }
  mocap.latency_s = node.at("latency_s").number();
  mocap.position_error_m = node.at("position_error_m").number();
  mocap.orientation_error_rad = node.at("orientation_error_rad").number();
  mocap.misalignment_rad = node.at("misalignment_rad").number();
  mocap.dropout_probability = node.at("dropout_probability").number();
  mocap.dropout_length_s = node.at("dropout_length_s").number();
  return mocap;
}

plant::RadioSettings read_radio(const ConfigNode& node) {
  plant::RadioSettings radio;
  radio.delay_s = node.at("delay_s").number();
  radio.jitter_s = node.at("jitter_s").number();
  radio.loss = node.at("loss").number();
  return radio;
}

plant::SupplySettings read_supply(const ConfigNode& node) {
  plant::SupplySettings supply;
  supply.ideal = node.at("ideal").boolean();
  supply.initial_state_of_charge = node.at("initial_state_of_charge").number();
  supply.rate_hz = node.at("rate_hz").number();
  return supply;
}

plant::AirSettings read_air(const ConfigNode& node) {
  plant::AirSettings air;
  air.drag = node.at("drag").boolean();
  air.wind_ned = node.at("wind_ned_m_s").vector3();
  air.gust_sigma_ned = node.at("gust_sigma_ned_m_s").vector3();
  air.gust_time_constant_s = node.at("gust_time_constant_s").number();
  if (const auto dryden = node.find("dryden")) {
    air.dryden.height_m = dryden->at("height_m").number(above(0.0));
    air.dryden.airspeed_m_s = dryden->at("airspeed_m_s").number();
  }
  if (const auto drag = node.find("rotor_drag_n_s2_per_m")) air.rotor_drag = drag->number();
  return air;
}

plant::GroundSettings read_ground(const ConfigNode& node) {
  plant::GroundSettings ground;
  ground.present = node.at("present").boolean();
  ground.leg_height_m = node.at("leg_height_m").number();
  ground.friction = node.at("friction").number();
  if (const auto radius = node.find("effect_rotor_radius_m")) ground.effect_rotor_radius_m = radius->number();
  return ground;
}

plant::SiteSettings read_site(const ConfigNode& node) {
  plant::SiteSettings site;
  site.latitude_deg = node.at("latitude_deg").number();
  site.longitude_deg = node.at("longitude_deg").number();
  site.altitude_m = node.at("altitude_m").number();
  site.magnetic_field_ned = node.at("magnetic_field_ned_gauss").vector3();
  return site;
}

plant::BarometerSettings read_barometer(const ConfigNode& node) {
  plant::BarometerSettings barometer;
  barometer.rate_hz = node.at("rate_hz").number();
  barometer.noise_pa = node.at("noise_pa").number();
  barometer.bias_sigma_pa = node.at("bias_pa").number();
  barometer.bias_walk_pa = node.at("bias_walk_pa_per_sqrt_s").number();
  return barometer;
}

plant::MagnetometerSettings read_magnetometer(const ConfigNode& node) {
  plant::MagnetometerSettings magnetometer;
  magnetometer.rate_hz = node.at("rate_hz").number();
  magnetometer.noise_gauss = node.at("noise_gauss").number();
  magnetometer.bias_sigma_gauss = node.at("bias_gauss").number();
  return magnetometer;
}

plant::GpsSettings read_gps(const ConfigNode& node) {
  plant::GpsSettings gps;
  gps.rate_hz = node.at("rate_hz").number();
  gps.position_noise_ned = node.at("position_noise_ned_m").vector3();
  gps.position_drift_ned = node.at("position_drift_ned_m").vector3();
  gps.drift_time_constant_s = node.at("drift_time_constant_s").number();
  gps.velocity_noise_ned = node.at("velocity_noise_ned_m_s").vector3();
  return gps;
}

plant::OdometrySettings read_odometry_drift(const ConfigNode& node) {
  plant::OdometrySettings odometry;
  odometry.position_drift_m = node.at("position_drift_m").number();
  odometry.heading_drift_rad = node.at("heading_drift_rad").number();
  odometry.drift_time_constant_s = node.at("drift_time_constant_s").number();
  return odometry;
}

plant::FaultKind read_fault_kind(const ConfigNode& node) {
  using Kind = plant::FaultKind;
  const auto named = [](Kind kind) { return std::make_pair(plant::to_string(kind), kind); };
  return node.choice<Kind>({named(Kind::kMocapStop), named(Kind::kMocapFreeze), named(Kind::kMocapUntracked),
                            named(Kind::kMocapJump), named(Kind::kMocapSwap), named(Kind::kMocapLatency),
                            named(Kind::kImuStop), named(Kind::kImuNan), named(Kind::kImuStuck),
                            named(Kind::kImuBias), named(Kind::kBatteryStop), named(Kind::kRotorSpeedsStop),
                            named(Kind::kBatteryDrop), named(Kind::kRotorThrust), named(Kind::kPush),
                            named(Kind::kWind), named(Kind::kCommandsStop), named(Kind::kCommandsDelay),
                            named(Kind::kOdometryJump)});
}

plant::Fault read_fault(const ConfigNode& node) {
  using Kind = plant::FaultKind;
  plant::Fault fault;
  fault.kind = read_fault_kind(node.at("kind"));
  fault.at_s = node.at("at_s").number();
  fault.for_s = node.at("for_s").number();
  switch (fault.kind) {
    case Kind::kMocapJump:
      fault.position_ned = node.at("position_ned_m").vector3();
      fault.rotation_frd = node.at("rotation_frd_rad").vector3();
      break;
    case Kind::kMocapSwap:
    case Kind::kOdometryJump:
      fault.position_ned = node.at("position_ned_m").vector3();
      fault.yaw_rad = node.at("yaw_rad").number();
      break;
    case Kind::kMocapLatency:
    case Kind::kCommandsDelay:
      fault.delay_s = node.at("delay_s").number();
      break;
    case Kind::kImuBias:
      fault.specific_force_frd = node.at("accelerometer_m_s2").vector3();
      fault.body_rates_frd = node.at("gyro_rad_s").vector3();
      break;
    case Kind::kBatteryDrop:
      fault.voltage_v = node.at("voltage_v").number();
      break;
    case Kind::kRotorThrust:
      fault.rotor = static_cast<int>(node.at("rotor").integer(1, plant::kMaxRotors));
      fault.factor = node.at("factor").number();
      break;
    case Kind::kPush:
      fault.force_ned = node.at("force_ned_n").vector3();
      fault.moment_frd = node.at("moment_frd_n_m").vector3();
      break;
    case Kind::kWind:
      fault.wind_ned = node.at("wind_ned_m_s").vector3();
      break;
    default:
      break;  // no parameters
  }
  return fault;
}

std::vector<plant::Fault> read_faults(const ConfigNode& root) {
  std::vector<plant::Fault> faults;
  const auto list = root.find("faults");
  if (!list) return faults;
  for (const ConfigNode& node : list->items()) faults.push_back(read_fault(node));
  return faults;
}

}  // namespace

plant::SimulationSettings parse_simulation_settings(std::string_view text, const std::string& file_name) {
  const ConfigNode root = parse_config(text, file_name);
  plant::SimulationSettings settings;
  root.read_known([&] {
    settings.name = root.at("name").text();
    settings.step_ns = std::llround(root.at("step_s").number(between(0.0, 1.0)) * 1.0e9);
    settings.command_timeout_s = root.at("command_timeout_s").number();
    if (const auto hold = root.find("command_hold_s")) settings.command_hold_s = hold->number();
    settings.rotor_speed_rate_hz = root.at("rotor_speed_rate_hz").number();
    settings.imu = read_imu(root.at("imu"));
    settings.mocap = read_mocap(root.at("mocap"));
    if (const auto radio = root.find("radio")) settings.radio = read_radio(*radio);
    settings.supply = read_supply(root.at("supply"));
    settings.air = read_air(root.at("air"));
    settings.ground = read_ground(root.at("ground"));
    settings.site = read_site(root.at("site"));
    settings.barometer = read_barometer(root.at("barometer"));
    settings.magnetometer = read_magnetometer(root.at("magnetometer"));
    settings.gps = read_gps(root.at("gps"));
    if (const auto odometry = root.find("odometry")) settings.odometry = read_odometry_drift(*odometry);
    settings.faults = read_faults(root);
  });
  reject_violations(root, plant::validate(settings));
  return settings;
}

plant::SimulationSettings load_simulation_settings(const std::string& path) {
  return parse_simulation_settings(read_text_file(path), path);
}

}  // namespace swiftlet::io
