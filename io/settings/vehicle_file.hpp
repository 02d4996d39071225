// The vehicle file: YAML in which every parameter is a map {value, unit, source}. source names the equation
// or measurement of the value, or is "estimate". config/vehicles/kaylion.yaml shows all keys.
#pragma once

#include <string>
#include <string_view>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/vehicle_uncertainty.hpp"

namespace swiftlet::io {

// Returns a vehicle that passes plant::validate(). Throws ConfigError for a missing or unknown key, a wrong
// unit, a missing source or a violated rule. file_name appears in messages only.
plant::Vehicle parse_vehicle(std::string_view text, const std::string& file_name);
plant::Vehicle load_vehicle(const std::string& path);

// Reads the optional section "uncertainty", the uncertainty of the identified parameters; empty if the file
// has none:
//   uncertainty:
//     parameters:
//       - {parameter: motor.k2, standard_error: 1.2e-5, interval_95: [9.9e-4, 1.04e-3]}
//     correlations:
//       - {between: [motor.k2, motor.k3], value: -0.97}
// parse_vehicle() checks this section too. Throws ConfigError.
plant::VehicleUncertainty parse_vehicle_uncertainty(std::string_view text, const std::string& file_name);
plant::VehicleUncertainty load_vehicle_uncertainty(const std::string& path);

}  // namespace swiftlet::io
