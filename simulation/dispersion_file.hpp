// Vary files (YAML), what the runs of a batch differ in:
//
//   name: kaylion        # optional; the file's name without its ending
//   parameters:
//     vehicle.mass: {distribution: normal, mean: 1, sigma: 0.02, min: 0.95, max: 1.05, unit: nominal,
//                    source: estimate}
//     simulation.mocap.latency_s: {distribution: uniform, min: 0.005, max: 0.02, unit: s, source: estimate}
//     vehicle.battery.internal_resistance: {distribution: log_uniform, min: 0.5, max: 2, unit: nominal,
//                                           source: estimate}
//
// A parameter is a key of the vehicle file or of the simulation file behind "vehicle." or "simulation.", a
// component of it (inertia.xx, wind_ned_m_s.north), or all of the inertia; parameters() of
// simulation/dispersion.hpp lists them, as does the refusal of any other key. `unit` is the parameter's own
// (that of a simulation key stands in its name), or nominal: what is drawn multiplies the value in the file.
//
// uniform: evenly between min and max. log_uniform: its logarithm is; min above 0. normal: mean and sigma,
// and what falls outside min .. max is drawn again; mean between them, and they at least a sigma apart.
// source: a text that says where the range is from, or estimate.
#pragma once

#include <string>

#include "swiftlet/simulation/dispersion.hpp"

namespace swiftlet::ground {

// Throws runtime::ConfigError with file, line, key, value and limit for whatever breaks the form, or lets a
// parameter alone leave the range that the vehicle or the simulation may have.
Dispersion load_dispersion_file(const std::string& path, const World& nominal);
Dispersion parse_vary_file(const std::string& text, const std::string& file_name, const World& nominal);

}  // namespace swiftlet::ground
