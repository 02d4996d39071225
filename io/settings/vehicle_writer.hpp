// Writes vehicle files, and reads the sources of their values.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/vehicle_uncertainty.hpp"

namespace swiftlet::io {

// The source of each quantity by its key, such as "motor.k2" or "rotors[0].position_frd". The readers throw
// ConfigError for invalid YAML.
using VehicleSources = std::map<std::string, std::string>;
VehicleSources parse_vehicle_sources(std::string_view text, const std::string& file_name);
VehicleSources load_vehicle_sources(const std::string& path);

// Returns the text of a vehicle file. It starts with the lines of comment, each prefixed with "# ". A key
// without an entry in sources gets the source "estimate". Numbers are written in the shortest form that reads
// back exactly, so that parse_vehicle() returns the same vehicle. The sources of the inertia's elements, such
// as "inertia.xx", are joined to one.
std::string vehicle_text(const plant::Vehicle& vehicle, const VehicleSources& sources,
                         const plant::VehicleUncertainty& uncertainty, const std::string& comment);

}  // namespace swiftlet::io
