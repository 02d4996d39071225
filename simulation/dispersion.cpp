#include "swiftlet/simulation/dispersion.hpp"

#include <algorithm>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/math/linear_algebra.hpp"
#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::simulation {
namespace {

using Values = std::vector<double*>;

constexpr int kMostRejected = 100;
constexpr const char* kArmatureResistance = "vehicle.motor.armature_resistance";

double drawn(const ParameterDistribution& distribution, math::RandomStream& random) {
  switch (distribution.distribution) {
    case Distribution::kUniform:
      return random.uniform(distribution.min, distribution.max);
    case Distribution::kLogUniform:
      return random.log_uniform(distribution.min, distribution.max);
    case Distribution::kNormal:
      return random.truncated_normal(distribution.mean, distribution.sigma, distribution.min,
                                     distribution.max);
  }
  return 0.0;
}

std::vector<double> drawn(const Dispersion& dispersion, std::vector<math::RandomStream>& streams) {
  std::vector<double> values(streams.size());
  if (dispersion.correlation_root.size() == 0) {
    for (std::size_t i = 0; i < streams.size(); ++i)
      values[i] = drawn(dispersion.distributions[i], streams[i]);
    return values;
  }
  Eigen::VectorXd deviates(static_cast<Eigen::Index>(streams.size()));
  for (std::size_t i = 0; i < streams.size(); ++i)
    deviates[static_cast<Eigen::Index>(i)] = streams[i].normal();
  const Eigen::VectorXd errors = dispersion.correlation_root * deviates;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const ParameterDistribution& distribution = dispersion.distributions[i];
    values[i] = distribution.mean + distribution.sigma * errors[static_cast<Eigen::Index>(i)];
  }
  return values;
}

// K2 K3 / k_Q: the upper limit of R_a by Eq. (21), at which the friction F is 0.
double frictionless_resistance(const plant::Vehicle& vehicle) {
  return vehicle.motor.k2 * vehicle.motor.k3 / vehicle.rotor.torque;
}

bool varies_resistance(const Dispersion& dispersion) {
  return std::any_of(dispersion.distributions.begin(), dispersion.distributions.end(),
                     [](const ParameterDistribution& distribution) {
                       return distribution.what().name == kArmatureResistance;
                     });
}

Values inertia(World& w) {
  double* const first = w.vehicle.inertia.data();
  Values values;
  for (int i = 0; i < 9; ++i) values.push_back(first + i);
  return values;
}

std::vector<Parameter> all_parameters() {
  return {
      {"vehicle.mass", "kg", "mass", [](World& w) -> Values { return {&w.vehicle.mass_kg}; }},
      {"vehicle.inertia", "", "", inertia},
      {"vehicle.inertia.xx", "kg*m^2", "", [](World& w) -> Values { return {&w.vehicle.inertia(0, 0)}; }},
      {"vehicle.inertia.yy", "kg*m^2", "", [](World& w) -> Values { return {&w.vehicle.inertia(1, 1)}; }},
      {"vehicle.inertia.zz", "kg*m^2", "", [](World& w) -> Values { return {&w.vehicle.inertia(2, 2)}; }},
      {"vehicle.linear_drag", "N*s/m", "linear_drag",
       [](World& w) -> Values { return {&w.vehicle.linear_drag}; }},
      {"vehicle.rotor.thrust_factor", "N*s^2", "rotor.thrust_factor",
       [](World& w) -> Values { return {&w.vehicle.rotor.thrust}; }},
      {"vehicle.rotor.torque_factor", "N*m*s^2", "rotor.torque_factor",
       [](World& w) -> Values { return {&w.vehicle.rotor.torque}; }},
      {"vehicle.motor.time_constant", "s", "motor.time_constant",
       [](World& w) -> Values { return {&w.vehicle.motor.time_constant_s}; }},
      {"vehicle.motor.k2", "V*s/rad", "motor.k2", [](World& w) -> Values { return {&w.vehicle.motor.k2}; }},
      {"vehicle.motor.k3", "V*s^2/rad^2", "motor.k3",
       [](World& w) -> Values { return {&w.vehicle.motor.k3}; }},
      {kArmatureResistance, "ohm", "motor.armature_resistance",
       [](World& w) -> Values { return {&w.vehicle.motor.armature_resistance_ohm}; }},
      {"vehicle.esc.gain", "1", "esc.gain", [](World& w) -> Values { return {&w.vehicle.esc.gain}; }},
      {"vehicle.esc.offset", "V^2", "esc.offset",
       [](World& w) -> Values { return {&w.vehicle.esc.offset_v2}; }},
      {"vehicle.battery.capacity", "A*h", "battery.capacity",
       [](World& w) -> Values { return {&w.vehicle.battery.capacity_ah}; }},
      {"vehicle.battery.internal_resistance", "ohm", "battery.internal_resistance",
       [](World& w) -> Values { return {&w.vehicle.battery.internal_resistance_ohm}; }},
      {"vehicle.battery.sag_time_constant", "s", "battery.sag_time_constant",
       [](World& w) -> Values { return {&w.vehicle.battery.sag_time_constant_s}; }},
      {"vehicle.battery.electronics_current", "A", "battery.electronics_current",
       [](World& w) -> Values { return {&w.vehicle.battery.electronics_current_a}; }},
      {"simulation.imu.accelerometer_noise_m_s2_per_sqrt_hz", "m/s^2/sqrt(Hz)",
       "imu.accelerometer_noise_m_s2_per_sqrt_hz",
       [](World& w) -> Values { return {&w.simulation.imu.accelerometer_noise_density}; }},
      {"simulation.imu.gyro_noise_rad_s_per_sqrt_hz", "rad/s/sqrt(Hz)", "imu.gyro_noise_rad_s_per_sqrt_hz",
       [](World& w) -> Values { return {&w.simulation.imu.gyro_noise_density}; }},
      {"simulation.imu.accelerometer_bias_m_s2", "m/s^2", "imu.accelerometer_bias_m_s2",
       [](World& w) -> Values { return {&w.simulation.imu.accelerometer_bias_sigma}; }},
      {"simulation.imu.gyro_bias_rad_s", "rad/s", "imu.gyro_bias_rad_s",
       [](World& w) -> Values { return {&w.simulation.imu.gyro_bias_sigma}; }},
      {"simulation.imu.accelerometer_bias_walk_m_s2_per_sqrt_s", "m/s^2/sqrt(s)",
       "imu.accelerometer_bias_walk_m_s2_per_sqrt_s",
       [](World& w) -> Values { return {&w.simulation.imu.accelerometer_bias_walk}; }},
      {"simulation.imu.gyro_bias_walk_rad_s_per_sqrt_s", "rad/s/sqrt(s)",
       "imu.gyro_bias_walk_rad_s_per_sqrt_s",
       [](World& w) -> Values { return {&w.simulation.imu.gyro_bias_walk}; }},
      {"simulation.mocap.latency_s", "s", "mocap.latency_s",
       [](World& w) -> Values { return {&w.simulation.mocap.latency_s}; }},
      {"simulation.mocap.position_error_m", "m", "mocap.position_error_m",
       [](World& w) -> Values { return {&w.simulation.mocap.position_error_m}; }},
      {"simulation.mocap.orientation_error_rad", "rad", "mocap.orientation_error_rad",
       [](World& w) -> Values { return {&w.simulation.mocap.orientation_error_rad}; }},
      {"simulation.mocap.misalignment_rad", "rad", "mocap.misalignment_rad",
       [](World& w) -> Values { return {&w.simulation.mocap.misalignment_rad}; }},
      {"simulation.mocap.dropout_probability", "1", "mocap.dropout_probability",
       [](World& w) -> Values { return {&w.simulation.mocap.dropout_probability}; }},
      {"simulation.mocap.dropout_length_s", "s", "mocap.dropout_length_s",
       [](World& w) -> Values { return {&w.simulation.mocap.dropout_length_s}; }},
      {"simulation.supply.initial_state_of_charge", "1", "supply.initial_state_of_charge",
       [](World& w) -> Values { return {&w.simulation.supply.initial_state_of_charge}; }},
      {"simulation.air.wind_ned_m_s.north", "m/s", "air.wind_ned_m_s[0]",
       [](World& w) -> Values { return {&w.simulation.air.wind_ned.x()}; }},
      {"simulation.air.wind_ned_m_s.east", "m/s", "air.wind_ned_m_s[1]",
       [](World& w) -> Values { return {&w.simulation.air.wind_ned.y()}; }},
      {"simulation.air.wind_ned_m_s.down", "m/s", "air.wind_ned_m_s[2]",
       [](World& w) -> Values { return {&w.simulation.air.wind_ned.z()}; }},
      {"simulation.air.gust_sigma_ned_m_s.north", "m/s", "air.gust_sigma_ned_m_s[0]",
       [](World& w) -> Values { return {&w.simulation.air.gust_sigma_ned.x()}; }},
      {"simulation.air.gust_sigma_ned_m_s.east", "m/s", "air.gust_sigma_ned_m_s[1]",
       [](World& w) -> Values { return {&w.simulation.air.gust_sigma_ned.y()}; }},
      {"simulation.air.gust_sigma_ned_m_s.down", "m/s", "air.gust_sigma_ned_m_s[2]",
       [](World& w) -> Values { return {&w.simulation.air.gust_sigma_ned.z()}; }},
      {"simulation.air.gust_time_constant_s", "s", "air.gust_time_constant_s",
       [](World& w) -> Values { return {&w.simulation.air.gust_time_constant_s}; }},
      {"simulation.ground.friction", "1", "ground.friction",
       [](World& w) -> Values { return {&w.simulation.ground.friction}; }},
  };
}

}  // namespace

const std::vector<Parameter>& parameters() {
  static const std::vector<Parameter> all = all_parameters();
  return all;
}

std::vector<plant::Violation> validate(const World& world) {
  std::vector<plant::Violation> violations = plant::validate(world.vehicle);
  const std::vector<plant::Violation> of_settings = plant::validate(world.simulation);
  violations.insert(violations.end(), of_settings.begin(), of_settings.end());
  return violations;
}

double apply(World& world, const ParameterDistribution& distribution, double value) {
  const Values places = distribution.what().in(world);
  for (double* const place : places) *place = distribution.of_nominal ? *place * value : value;
  return places.size() == 1 ? *places.front() : value;
}

Dispersion dispersion_of(const plant::VehicleUncertainty& uncertainty, const plant::Vehicle& vehicle,
                         const std::string& file) {
  if (uncertainty.parameters.empty()) {
    throw io::ConfigError(
        file, 0, "uncertainty",
        "is missing, must list the standard errors of the parameters; `swiftlet identify` writes it");
  }
  Dispersion out;
  out.file = file;
  out.name = kUncertainty;
  const std::vector<Parameter>& all = parameters();
  for (const plant::ParameterUncertainty& uncertain : uncertainty.parameters) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const Parameter& parameter) {
      return parameter.name == "vehicle." + uncertain.parameter;
    });
    if (found == all.end())
      throw io::ConfigError(file, 0, "uncertainty", uncertain.parameter + " cannot be varied");
    ParameterDistribution distribution;
    distribution.parameter = static_cast<std::size_t>(found - all.begin());
    distribution.distribution = Distribution::kNormal;
    World world{vehicle, {}};
    distribution.mean = *found->in(world).front();
    distribution.sigma = uncertain.standard_error;
    distribution.min = uncertain.low;
    distribution.max = uncertain.high;
    out.distributions.push_back(distribution);
  }
  std::sort(out.distributions.begin(), out.distributions.end(),
            [](const ParameterDistribution& a, const ParameterDistribution& b) {
              return a.parameter < b.parameter;
            });

  const auto count = static_cast<Eigen::Index>(out.distributions.size());
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(count, count);
  const auto index_of = [&](const std::string& key) {
    Eigen::Index i = 0;
    while (i < count && out.distributions[static_cast<std::size_t>(i)].what().name != "vehicle." + key) ++i;
    return i;
  };
  for (const plant::ParameterCorrelation& pair : uncertainty.correlations) {
    const Eigen::Index i = index_of(pair.first);
    const Eigen::Index j = index_of(pair.second);
    if (i < count && j < count && i != j) correlation(i, j) = correlation(j, i) = pair.value;
  }
  // A matrix of rounded correlations may have slightly negative eigenvalues. They are set to 0.
  const math::SymmetricEigen eigen = math::symmetric_eigen(correlation);
  out.correlation_root = eigen.vectors * eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal();
  return out;
}

DispersionSample draw(const Dispersion& dispersion, const World& nominal, std::uint64_t seed) {
  std::vector<math::RandomStream> streams;
  for (const ParameterDistribution& distribution : dispersion.distributions)
    streams.emplace_back(seed, plant::streams::of_name(distribution.what().name));
  const bool resistance_follows = !varies_resistance(dispersion);

  std::vector<plant::Violation> violations;
  for (int rejected = 0; rejected < kMostRejected; ++rejected) {
    DispersionSample draw{nominal, {}, rejected};
    const std::vector<double> values = drawn(dispersion, streams);
    for (std::size_t i = 0; i < streams.size(); ++i)
      draw.values.push_back(apply(draw.world, dispersion.distributions[i], values[i]));
    plant::Vehicle& vehicle = draw.world.vehicle;
    if (resistance_follows)
      vehicle.motor.armature_resistance_ohm *=
          frictionless_resistance(vehicle) / frictionless_resistance(nominal.vehicle);
    violations = validate(draw.world);
    if (violations.empty()) return draw;
  }
  throw io::ConfigError(dispersion.file, 0, "parameters",
                        "seed " + std::to_string(seed) + ": " + std::to_string(kMostRejected) +
                            " samples in a row break a rule, the last: " + violations.front().key + " " +
                            violations.front().message);
}

}  // namespace swiftlet::simulation
