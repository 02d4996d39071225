// Writes vehicle files, and reads what stands in them beside the vehicle itself.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/vehicle_uncertainty.hpp"

namespace swiftlet::runtime {

// The source of each quantity by its key, "motor.k2", "rotors[0].position_frd". Throws ConfigError for what
// is no YAML.
using VehicleSources = std::map<std::string, std::string>;
VehicleSources parse_vehicle_sources(std::string_view text, const std::string& file_name);
VehicleSources load_vehicle_sources(const std::string& path);

// The text of a vehicle file, comment in front (lines without "# "). A key that sources does not hold becomes
// an estimate. Numbers are in the shortest form that reads back as the same, so that parse_vehicle() gives
// this very vehicle. Sources of elements of the inertia, "inertia.xx", are joined.
std::string vehicle_text(const plant::Vehicle& vehicle, const VehicleSources& sources,
                         const plant::VehicleUncertainty& uncertainty, const std::string& comment);

}  // namespace swiftlet::runtime
