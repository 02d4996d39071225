// Dispersion of a batch: parameters of the vehicle and of the simulation that vary from run to run, each with
// a distribution. A seed gives the same sample on every machine, independent of earlier samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/vehicle_uncertainty.hpp"
#include "swiftlet/plant/model/violation.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::simulation {

struct World {
  plant::Vehicle vehicle;
  plant::SimulationSettings simulation;
};

// A parameter that can be varied.
struct Parameter {
  std::string name;  // "vehicle." or "simulation." plus the key in that file
  std::string unit;  // empty: several values, which are all multiplied by the same factor
  std::string rule;  // key of validate()'s violations that concern only this value; empty: must be above 0
  std::size_t index = 0;  // in parameters()

  std::vector<double*> in(World& world) const;  // the values in a world
};

// The numbers that every vehicle and simulation file has and that may vary, in the order of columns and draws.
const std::vector<Parameter>& parameters();

enum class Distribution {
  kUniform,
  kLogUniform,
  kNormal,  // truncated to its limits
};

struct ParameterDistribution {
  std::size_t parameter = 0;  // index into parameters()
  Distribution distribution = Distribution::kUniform;
  bool of_nominal = false;  // true: the sample multiplies the nominal value; false: it replaces it
  double mean = 0.0;        // kNormal only
  double sigma = 0.0;       // kNormal only
  double min = 0.0;
  double max = 0.0;

  const Parameter& what() const { return parameters()[parameter]; }
};

struct Dispersion {
  std::string file;  // used in messages
  std::string name;
  std::vector<ParameterDistribution> distributions;  // in the order of parameters(), without duplicates
  // Square root R of the correlation matrix R R' of the parameters' errors. If it is not empty, all
  // distributions are normal, correlated and not truncated.
  Eigen::MatrixXd correlation_root;
};

// Dispersion that follows the uncertainty section of a vehicle file: each parameter is normal about the
// file's value with its standard error, and the errors are correlated. Throws io::ConfigError with
// `file` if the section is missing or names a parameter that cannot be varied.
Dispersion dispersion_of(const plant::VehicleUncertainty& uncertainty, const plant::Vehicle& vehicle,
                         const std::string& file);
inline constexpr const char* kUncertainty = "uncertainty";  // its name, also on the command line

struct DispersionSample {
  World world;
  std::vector<double> values;  // sampled values in their units, or the factor for parameters without a unit
  int rejected = 0;            // invalid samples drawn before this one
};

// Returns the rules that a world violates. Keys are those of the vehicle and the simulation file.
std::vector<plant::Violation> validate(const World& world);

// Sets the parameter in the world to `value`, or multiplies it by `value` if of_nominal. Returns the entry of
// DispersionSample::values.
double apply(World& world, const ParameterDistribution& distribution, double value);

// Draws the sample of a seed. Each parameter has a random stream of its own, named after it, so that neither
// the order of keys nor the other parameters change its value. An invalid world, such as one whose inertia
// violates the triangle inequality, is rejected and all parameters are drawn again. Unless the armature
// resistance is varied itself, it follows K2, K3 and k_Q such that the ratio of K1, Eq. (21), to K2 remains
// the nominal one. Throws io::ConfigError if 100 samples in a row are invalid.
DispersionSample draw(const Dispersion& dispersion, const World& nominal, std::uint64_t seed);

}  // namespace swiftlet::simulation
