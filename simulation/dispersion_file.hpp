// Dispersion files (YAML) list the parameters that vary between the runs of a batch:
//
//   name: kaylion        # optional; default: the file's name without its extension
//   parameters:
//     vehicle.mass: {distribution: normal, mean: 1, sigma: 0.02, min: 0.95, max: 1.05, unit: nominal,
//                    source: estimate}
//     simulation.mocap.latency_s: {distribution: uniform, min: 0.005, max: 0.02, unit: s, source: estimate}
//     vehicle.battery.internal_resistance: {distribution: log_uniform, min: 0.5, max: 2, unit: nominal,
//                                           source: estimate}
//
// A parameter is "vehicle." or "simulation." followed by a key of that file, a component of such a key
// (inertia.xx, wind_ned_m_s.north), or the whole inertia. parameters() of simulation/dispersion.hpp lists
// them; the error for an unknown key lists them too. `unit` is the parameter's own unit (a simulation key
// contains it), or nominal: the sample then multiplies the value in the file.
//
// uniform: uniform between min and max.
// log_uniform: the logarithm is uniform; min must be above 0.
// normal: mean and sigma, truncated to min .. max; the mean must lie between them, and they must be at least
// one sigma apart.
// source: a text that states the origin of the range, or estimate.
#pragma once

#include <string>

#include "swiftlet/simulation/dispersion.hpp"

namespace swiftlet::simulation {

// Both functions throw io::ConfigError with file, line, key, value and limit if the file is malformed or
// if min or max of a parameter violates a rule of the vehicle or the simulation by itself.
Dispersion load_dispersion_file(const std::string& path, const World& nominal);
Dispersion parse_dispersion_file(const std::string& text, const std::string& file_name, const World& nominal);

}  // namespace swiftlet::simulation
