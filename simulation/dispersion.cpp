#include "swiftlet/simulation/dispersion.hpp"

#include <algorithm>
#include <utility>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/math/linear_algebra.hpp"
#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/model/setting_values.hpp"
#include "swiftlet/plant/model/vehicle_visit.hpp"
#include "swiftlet/plant/simulation/settings_visit.hpp"
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

Values whole(Eigen::Matrix3d& matrix) {
  Values values;
  for (Eigen::Index i = 0; i < matrix.size(); ++i) values.push_back(matrix.data() + i);
  return values;
}

struct Place {
  Parameter parameter;
  Values values;
};

// The parameters with their values in a world.
std::vector<Place> places(World& world) {
  std::vector<Place> out;
  const auto add = [&](const std::string& file, const std::vector<plant::SettingValue>& values) {
    for (const plant::SettingValue& one : values) {
      if (!one.varies) continue;
      if (one.name == plant::kInertiaKeys[0])
        out.push_back({{file + "inertia", "", "", out.size()}, whole(world.vehicle.inertia)});
      const bool has_rule = one.setting.range.kind != plant::Range::Kind::kAny;
      out.push_back({{file + one.name, one.setting.unit, has_rule ? one.key : "", out.size()}, {one.place}});
    }
  };
  add("vehicle.", plant::setting_values(world.vehicle));
  add("simulation.", plant::setting_values(world.simulation));
  return out;
}

}  // namespace

const std::vector<Parameter>& parameters() {
  static const std::vector<Parameter> all = [] {
    World world;
    std::vector<Parameter> out;
    for (Place& place : places(world)) out.push_back(std::move(place.parameter));
    return out;
  }();
  return all;
}

Values Parameter::in(World& world) const { return places(world)[index].values; }

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
