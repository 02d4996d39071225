#include "swiftlet/io/settings/simulation_file.hpp"

#include <cmath>
#include <iterator>
#include <vector>

#include "swiftlet/io/config.hpp"
#include "swiftlet/io/settings/settings_reader.hpp"
#include "swiftlet/io/settings/violations.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/plant/simulation/settings_visit.hpp"

namespace swiftlet::io {

namespace {

plant::Fault read_fault(const ConfigNode& node) {
  using Kind = plant::FaultKind;
  plant::Fault fault;
  fault.kind = static_cast<Kind>(
      node.at("kind").choice_index({std::begin(plant::kFaultKindNames), std::end(plant::kFaultKindNames)}));
  fault.at_s = node.at("at_s").number();
  fault.for_s = node.at("for_s").number();
  switch (fault.kind) {
    case Kind::kMocapJump:
      fault.position_ned = node.at("position_ned_m").vector3();
      fault.rotation_frd = node.at("rotation_frd_rad").vector3();
      break;
    case Kind::kMocapSwap:
    case Kind::kOdometryJump:
      fault.position_ned = node.at("position_ned_m").vector3();
      fault.yaw_rad = node.at("yaw_rad").number();
      break;
    case Kind::kMocapLatency:
    case Kind::kCommandsDelay:
      fault.delay_s = node.at("delay_s").number();
      break;
    case Kind::kImuBias:
      fault.specific_force_frd = node.at("accelerometer_m_s2").vector3();
      fault.body_rates_frd = node.at("gyro_rad_s").vector3();
      break;
    case Kind::kBatteryDrop:
      fault.voltage_v = node.at("voltage_v").number();
      break;
    case Kind::kRotorThrust:
      fault.rotor = static_cast<int>(node.at("rotor").integer(1, plant::kMaxRotors));
      fault.factor = node.at("factor").number();
      break;
    case Kind::kPush:
      fault.force_ned = node.at("force_ned_n").vector3();
      fault.moment_frd = node.at("moment_frd_n_m").vector3();
      break;
    case Kind::kWind:
      fault.wind_ned = node.at("wind_ned_m_s").vector3();
      break;
    default:
      break;  // no parameters
  }
  return fault;
}

std::vector<plant::Fault> read_faults(const ConfigNode& root) {
  std::vector<plant::Fault> faults;
  const auto list = root.find("faults");
  if (!list) return faults;
  for (const ConfigNode& node : list->items()) faults.push_back(read_fault(node));
  return faults;
}

}  // namespace

plant::SimulationSettings parse_simulation_settings(std::string_view text, const std::string& file_name) {
  const ConfigNode root = parse_config(text, file_name);
  plant::SimulationSettings settings;
  root.read_known([&] {
    settings.name = root.at("name").text();
    settings.step_ns = std::llround(root.at("step_s").number(between(0.0, 1.0)) * 1.0e9);
    read_section(SettingsReader(root, NumbersAre::kPlain), settings);
    if (const auto dryden = root.at("air").find("dryden")) dryden->at("height_m").number(above(0.0));
    settings.faults = read_faults(root);
  });
  reject_violations(root, plant::validate(settings));
  return settings;
}

plant::SimulationSettings load_simulation_settings(const std::string& path) {
  return parse_simulation_settings(read_text_file(path), path);
}

}  // namespace swiftlet::io
