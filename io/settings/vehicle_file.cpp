#include "swiftlet/io/settings/vehicle_file.hpp"

#include <algorithm>

#include "swiftlet/io/config.hpp"
#include "swiftlet/io/nearest_name.hpp"
#include "swiftlet/io/settings/settings_reader.hpp"
#include "swiftlet/io/settings/violations.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/plant/model/plausibility.hpp"
#include "swiftlet/plant/model/rotor.hpp"
#include "swiftlet/plant/model/setting_values.hpp"
#include "swiftlet/plant/model/vehicle_visit.hpp"

namespace swiftlet::io {

// The file gives either the factors of Eq. (25) and (26) or the coefficients of Eq. (23) and (24).
void read_section(const SettingsReader& reader, plant::RotorCoefficients& rotor) {
  const ConfigNode& node = reader.node();
  if (!node.find("thrust_coefficient")) {
    visit(rotor, reader);
    return;
  }
  plant::BladeCoefficients blade;
  blade.thrust = node.at("thrust_coefficient").quantity("1").number(above(0.0));
  blade.torque = node.at("torque_coefficient").quantity("1").number(above(0.0));
  blade.radius_m = node.at("radius").quantity("m").number(above(0.0));
  blade.air_density = node.at("air_density").quantity("kg/m^3").number(above(0.0));
  rotor = plant::rotor_coefficients(blade);
}

namespace {

using plant::Vehicle;

// Reads the key of a scalar vehicle parameter that may have an uncertainty.
std::string read_parameter_key(const ConfigNode& node) {
  Vehicle vehicle;
  std::vector<std::string> keys;
  std::string known;
  for (const plant::SettingValue& one : plant::setting_values(vehicle)) {
    if (!one.varies) continue;
    keys.push_back(one.name);
    known += (known.empty() ? "" : ", ") + one.name;
  }
  std::string key = node.text();
  if (std::find(keys.begin(), keys.end(), key) != keys.end()) return key;
  node.fail("is " + key + ", must be one of " + known + or_nearest(keys, key));
}

plant::VehicleUncertainty read_uncertainty(const ConfigNode& root) {
  plant::VehicleUncertainty out;
  const auto section = root.find("uncertainty");
  if (!section) return out;
  for (const ConfigNode& item : section->at("parameters").items()) {
    plant::ParameterUncertainty parameter;
    parameter.parameter = read_parameter_key(item.at("parameter"));
    const auto is_same = [&](const plant::ParameterUncertainty& other) {
      return other.parameter == parameter.parameter;
    };
    if (std::any_of(out.parameters.begin(), out.parameters.end(), is_same))
      item.at("parameter").fail("is " + parameter.parameter + ", which is listed already");
    parameter.standard_error = item.at("standard_error").number(at_least(0.0));
    const std::vector<double> interval = item.at("interval_95").numbers(2, 2);
    parameter.low = interval[0];
    parameter.high = interval[1];
    if (!(parameter.low <= parameter.high)) item.at("interval_95").fail("must rise");
    out.parameters.push_back(parameter);
  }
  const auto correlations = section->find("correlations");
  if (!correlations) return out;
  for (const ConfigNode& item : correlations->items()) {
    const std::vector<ConfigNode> between = item.at("between").items(2, 2);
    out.correlations.push_back({read_parameter_key(between[0]), read_parameter_key(between[1]),
                                item.at("value").number(io::between(-1.0, 1.0))});
  }
  return out;
}

}  // namespace

Vehicle parse_vehicle(std::string_view text, const std::string& file_name) {
  const ConfigNode root = parse_config(text, file_name);
  Vehicle vehicle;
  root.read_known([&] {
    vehicle.name = root.at("name").text();
    read_section(SettingsReader(root, NumbersAre::kQuantities), vehicle);
    read_uncertainty(root);
  });
  reject_violations(root, plant::implausible(vehicle));
  reject_violations(root, plant::validate(vehicle));
  return vehicle;
}

Vehicle load_vehicle(const std::string& path) { return parse_vehicle(read_text_file(path), path); }

plant::VehicleUncertainty parse_vehicle_uncertainty(std::string_view text, const std::string& file_name) {
  return read_uncertainty(parse_config(text, file_name));
}

plant::VehicleUncertainty load_vehicle_uncertainty(const std::string& path) {
  return parse_vehicle_uncertainty(read_text_file(path), path);
}

}  // namespace swiftlet::io
