#include "swiftlet/io/settings/vehicle_file.hpp"

#include <algorithm>
#include <array>

#include "swiftlet/io/config.hpp"
#include "swiftlet/io/nearest_name.hpp"
#include "swiftlet/io/settings/violations.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/plant/model/plausibility.hpp"
#include "swiftlet/plant/model/rotor.hpp"

namespace swiftlet::io {

namespace {

using plant::Vehicle;

constexpr std::size_t kMaxBatteryPoints = 1000;

Eigen::Matrix3d read_inertia(const ConfigNode& node) {
  Eigen::Matrix3d inertia;
  const std::vector<ConfigNode> rows = node.quantity("kg*m^2").items(3, 3);
  for (int i = 0; i < 3; ++i) inertia.row(i) = rows[static_cast<std::size_t>(i)].vector3();
  return inertia;
}

std::vector<plant::RotorMount> read_rotors(const ConfigNode& node) {
  std::vector<plant::RotorMount> rotors;
  for (const ConfigNode& item : node.items(plant::kMinRotors, plant::kMaxRotors)) {
    plant::RotorMount mount;
    mount.position_frd = item.at("position_frd").quantity("m").vector3();
    mount.spin = item.at("spin").choice<plant::Spin>(
        {{"counter_clockwise", plant::Spin::kCounterClockwise}, {"clockwise", plant::Spin::kClockwise}});
    rotors.push_back(mount);
  }
  return rotors;
}

// The file gives either the factors of Eq. (25) and (26) or the coefficients of Eq. (23) and (24).
plant::RotorCoefficients read_rotor(const ConfigNode& node) {
  if (!node.find("thrust_coefficient")) {
    return {node.at("thrust_factor").quantity("N*s^2").number(),
            node.at("torque_factor").quantity("N*m*s^2").number()};
  }
  plant::BladeCoefficients blade;
  blade.thrust = node.at("thrust_coefficient").quantity("1").number(above(0.0));
  blade.torque = node.at("torque_coefficient").quantity("1").number(above(0.0));
  blade.radius_m = node.at("radius").quantity("m").number(above(0.0));
  blade.air_density = node.at("air_density").quantity("kg/m^3").number(above(0.0));
  return plant::rotor_coefficients(blade);
}

plant::Motor read_motor(const ConfigNode& node) {
  plant::Motor motor;
  motor.model = node.at("model").choice<plant::MotorModel>(
      {{"reduced", plant::MotorModel::kReduced}, {"physical", plant::MotorModel::kPhysical}});
  motor.time_constant_s = node.at("time_constant").quantity("s").number();
  motor.k2 = node.at("k2").quantity("V*s/rad").number();
  motor.k3 = node.at("k3").quantity("V*s^2/rad^2").number();
  motor.armature_resistance_ohm = node.at("armature_resistance").quantity("ohm").number();
  motor.armature_inductance_h = node.at("armature_inductance").quantity("H").number();
  return motor;
}

plant::Esc read_esc(const ConfigNode& node) {
  plant::Esc esc;
  esc.gain = node.at("gain").quantity("1").number();
  esc.offset_v2 = node.at("offset").quantity("V^2").number();
  esc.pulse_min_us = node.at("pulse_min").quantity("us").number();
  esc.pulse_range_us = node.at("pulse_range").quantity("us").number();
  return esc;
}

plant::BatteryParameters read_battery(const ConfigNode& node) {
  plant::BatteryParameters battery;
  battery.capacity_ah = node.at("capacity").quantity("A*h").number();
  battery.internal_resistance_ohm = node.at("internal_resistance").quantity("ohm").number();
  battery.sag_time_constant_s = node.at("sag_time_constant").quantity("s").number();
  battery.electronics_current_a = node.at("electronics_current").quantity("A").number();
  const ConfigNode curve = node.at("open_circuit");
  battery.state_of_charge = curve.at("state_of_charge").quantity("1").numbers(2, kMaxBatteryPoints);
  battery.open_circuit_voltage_v = curve.at("voltage").quantity("V").numbers(2, kMaxBatteryPoints);
  return battery;
}

// Reads the key of a scalar vehicle parameter that may have an uncertainty.
std::string read_parameter_key(const ConfigNode& node) {
  constexpr std::array<const char*, 17> kKeys = {"mass",
                                                 "linear_drag",
                                                 "inertia.xx",
                                                 "inertia.yy",
                                                 "inertia.zz",
                                                 "rotor.thrust_factor",
                                                 "rotor.torque_factor",
                                                 "motor.time_constant",
                                                 "motor.k2",
                                                 "motor.k3",
                                                 "motor.armature_resistance",
                                                 "motor.armature_inductance",
                                                 "esc.gain",
                                                 "esc.offset",
                                                 "esc.pulse_min",
                                                 "esc.pulse_range",
                                                 "battery.internal_resistance"};
  std::string key = node.text();
  if (std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end()) return key;
  std::string known;
  for (const char* name : kKeys) known += std::string(known.empty() ? "" : ", ") + name;
  node.fail("is " + key + ", must be one of " + known + or_nearest({kKeys.begin(), kKeys.end()}, key));
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
    vehicle.mass_kg = root.at("mass").quantity("kg").number();
    vehicle.inertia = read_inertia(root.at("inertia"));
    vehicle.linear_drag = root.at("linear_drag").quantity("N*s/m").number();
    vehicle.rotors = read_rotors(root.at("rotors"));
    vehicle.rotor = read_rotor(root.at("rotor"));
    vehicle.motor = read_motor(root.at("motor"));
    vehicle.esc = read_esc(root.at("esc"));
    vehicle.battery = read_battery(root.at("battery"));
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
