// What differs from run to run of a batch: parameters of the vehicle and of the simulated world, each drawn
// from a distribution. A seed gives the same draw on every machine, whatever was drawn before it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/vehicle_uncertainty.hpp"
#include "swiftlet/plant/model/violation.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::ground {

struct World {
  plant::Vehicle vehicle;
  plant::SimulationSettings simulation;
};

// What can be varied.
struct Parameter {
  std::string name;  // "vehicle." or "simulation.", and the key of that file
  std::string unit;  // empty: of several values, which are multiplied together
  std::string rule;  // the key under which validate() speaks of this value alone; empty: must be above 0
  std::vector<double*> (*in)(World& world);
};

const std::vector<Parameter>& parameters();  // in the order of columns and draws

enum class Distribution {
  kUniform,
  kLogUniform,
  kNormal,  // truncated to its limits
};

struct ParameterDistribution {
  std::size_t parameter = 0;  // index into parameters()
  Distribution distribution = Distribution::kUniform;
  bool of_nominal = false;  // what is drawn multiplies the nominal value; else it takes its place
  double mean = 0.0;        // of kNormal, as sigma
  double sigma = 0.0;
  double min = 0.0;
  double max = 0.0;

  const Parameter& what() const { return parameters()[parameter]; }
};

struct Dispersion {
  std::string file;  // for messages
  std::string name;
  std::vector<ParameterDistribution> distributions;  // in the order of parameters(), none twice
  // Where it is not empty, all variates are normal ones without limits, and correlated: R R' is the
  // correlation of their errors.
  Eigen::MatrixXd correlation_root;
};

// What the uncertainty of a vehicle's file lets its parameters be: each as far from the file's value as its
// standard error says, errors correlated as the file says. Throws runtime::ConfigError with `file` for a
// parameter that cannot be varied, and if there is none.
Dispersion dispersion_of(const plant::VehicleUncertainty& uncertainty, const plant::Vehicle& vehicle,
                         const std::string& file);
inline constexpr const char* kUncertainty = "uncertainty";  // its name, and that by which it is asked for

struct DispersionSample {
  World world;
  std::vector<double> values;  // of the variates, in their units; without a unit the factor
  int rejected = 0;            // draws before this one that broke a rule
};

// The rules that a world breaks, keys as in the two files.
std::vector<plant::Violation> validate(const World& world);

// Puts `value`, or so many times what is there, into the world. Returns what a Draw tells of it.
double apply(World& world, const ParameterDistribution& distribution, double value);

// The draw of a seed: of each parameter from the stream that bears its name, so that neither the order of
// keys nor the other parameters move it. A world that breaks a rule, as a body that no mass can have, is
// drawn anew as a whole. The armature resistance follows K2, K3 and k_Q, K1 of Eq. (21) keeping its share of
// K2, unless it is varied itself. Throws runtime::ConfigError if no draw in a hundred can be flown.
DispersionSample draw(const Dispersion& dispersion, const World& nominal, std::uint64_t seed);

}  // namespace swiftlet::ground
