// The vehicle file: YAML, every parameter a map {value, unit, source}, where source names the equation or
// measurement that the value is from, or says "estimate". config/vehicles/kaylion.yaml shows all keys.
#pragma once

#include <string>
#include <string_view>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/vehicle_uncertainty.hpp"

namespace swiftlet::runtime {

// A vehicle that plant::validate() finds no fault with. Throws ConfigError for anything else: a key that is
// missing or unknown, a unit that is not the expected one, a source that is left out, a rule that is broken.
// file_name is for the messages only.
plant::Vehicle parse_vehicle(std::string_view text, const std::string& file_name);
plant::Vehicle load_vehicle(const std::string& path);

// What the file's section "uncertainty" says of how sure its parameters are; empty where there is none:
//   uncertainty:
//     parameters:
//       - {parameter: motor.k2, standard_error: 1.2e-5, interval_95: [9.9e-4, 1.04e-3]}
//     correlations:
//       - {between: [motor.k2, motor.k3], value: -0.97}
// parse_vehicle() checks it too. Throws ConfigError.
plant::VehicleUncertainty parse_vehicle_uncertainty(std::string_view text, const std::string& file_name);
plant::VehicleUncertainty load_vehicle_uncertainty(const std::string& path);

}  // namespace swiftlet::runtime
