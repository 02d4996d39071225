#include "swiftlet/io/settings/vehicle_writer.hpp"

#include <array>
#include <sstream>

#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/flat_yaml.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {

namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

template <typename Numbers>
std::string list(const Numbers& numbers) {
  std::string out = "[";
  for (const double number : numbers) out += (out.size() > 1 ? ", " : "") + exact(number);
  return out + "]";
}

class Writer {
 public:
  explicit Writer(const VehicleSources& sources) : sources_(sources) {}

  std::string source(const std::string& key) const {
    const auto found = sources_.find(key);
    return quoted(found == sources_.end() ? "estimate" : found->second);
  }
  // {value: 1, unit: kg, source: "..."}
  std::string quantity(const std::string& key, const std::string& value, const char* unit) const {
    return "{value: " + value + ", unit: " + unit + ", source: " + source(key) + "}";
  }
  std::string quantity(const std::string& key, double value, const char* unit) const {
    return quantity(key, exact(value), unit);
  }

  std::string inertia_source() const {
    std::string joined;
    for (const char* key : plant::kInertiaKeys) {
      const auto found = sources_.find(key);
      if (found != sources_.end())
        joined += std::string(joined.empty() ? "" : "; ") + key + " " + found->second;
    }
    if (joined.empty()) return source("inertia");
    const auto rest = sources_.find("inertia");
    return quoted(joined + "; the rest " + (rest == sources_.end() ? "estimate" : rest->second));
  }

 private:
  const VehicleSources& sources_;
};

void write_inertia(std::ostream& out, const Eigen::Matrix3d& inertia, const Writer& writer) {
  out << "inertia:\n  value:\n";
  for (int i = 0; i < 3; ++i)
    out << "    - " << list(std::array<double, 3>{inertia(i, 0), inertia(i, 1), inertia(i, 2)}) << '\n';
  out << "  unit: kg*m^2\n  source: " << writer.inertia_source() << '\n';
}

void write_rotors(std::ostream& out, const std::vector<plant::RotorMount>& rotors, const Writer& writer) {
  out << "rotors:\n";
  for (std::size_t i = 0; i < rotors.size(); ++i) {
    const Eigen::Vector3d& p = rotors[i].position_frd;
    const std::string key = "rotors[" + std::to_string(i) + "].position_frd";
    out << "  - position_frd: " << writer.quantity(key, list(std::array<double, 3>{p.x(), p.y(), p.z()}), "m")
        << "\n    spin: " << (rotors[i].spin == plant::Spin::kClockwise ? "clockwise" : "counter_clockwise")
        << '\n';
  }
}

void write_motor(std::ostream& out, const plant::Motor& motor, const Writer& writer) {
  out << "motor:\n  model: " << (motor.model == plant::MotorModel::kPhysical ? "physical" : "reduced")
      << "\n  time_constant: " << writer.quantity("motor.time_constant", motor.time_constant_s, "s")
      << "\n  k2: " << writer.quantity("motor.k2", motor.k2, "V*s/rad")
      << "\n  k3: " << writer.quantity("motor.k3", motor.k3, "V*s^2/rad^2") << "\n  armature_resistance: "
      << writer.quantity("motor.armature_resistance", motor.armature_resistance_ohm, "ohm")
      << "\n  armature_inductance: "
      << writer.quantity("motor.armature_inductance", motor.armature_inductance_h, "H") << '\n';
}

void write_esc(std::ostream& out, const plant::Esc& esc, const Writer& writer) {
  out << "esc:\n  gain: " << writer.quantity("esc.gain", esc.gain, "1")
      << "\n  offset: " << writer.quantity("esc.offset", esc.offset_v2, "V^2")
      << "\n  pulse_min: " << writer.quantity("esc.pulse_min", esc.pulse_min_us, "us")
      << "\n  pulse_range: " << writer.quantity("esc.pulse_range", esc.pulse_range_us, "us") << '\n';
}

void write_battery(std::ostream& out, const plant::BatteryParameters& battery, const Writer& writer) {
  out << "battery:\n  capacity: " << writer.quantity("battery.capacity", battery.capacity_ah, "A*h")
      << "\n  internal_resistance: "
      << writer.quantity("battery.internal_resistance", battery.internal_resistance_ohm, "ohm")
      << "\n  sag_time_constant: "
      << writer.quantity("battery.sag_time_constant", battery.sag_time_constant_s, "s")
      << "\n  electronics_current: "
      << writer.quantity("battery.electronics_current", battery.electronics_current_a, "A")
      << "\n  open_circuit:\n    state_of_charge: "
      << writer.quantity("battery.open_circuit.state_of_charge", list(battery.state_of_charge), "1")
      << "\n    voltage: "
      << writer.quantity("battery.open_circuit.voltage", list(battery.open_circuit_voltage_v), "V") << '\n';
}

void write_uncertainty(std::ostream& out, const plant::VehicleUncertainty& uncertainty) {
  if (uncertainty.parameters.empty()) return;
  out << "\n# Uncertainty of the identified parameters, in their units, and correlations of their "
         "errors.\n"
         "uncertainty:\n  parameters:\n";
  for (const plant::ParameterUncertainty& p : uncertainty.parameters) {
    out << "    - {parameter: " << p.parameter << ", standard_error: " << exact(p.standard_error)
        << ", interval_95: " << list(std::array<double, 2>{p.low, p.high}) << "}\n";
  }
  if (uncertainty.correlations.empty()) return;
  out << "  correlations:\n";
  for (const plant::ParameterCorrelation& c : uncertainty.correlations)
    out << "    - {between: [" << c.first << ", " << c.second << "], value: " << exact(c.value) << "}\n";
}

}  // namespace

VehicleSources parse_vehicle_sources(std::string_view text, const std::string& file_name) {
  constexpr std::string_view kEnding = ".source";
  VehicleSources out;
  for (const auto& [key, value] : flatten_yaml(text, file_name)) {
    if (key.size() > kEnding.size() && key.compare(key.size() - kEnding.size(), kEnding.size(), kEnding) == 0)
      out[key.substr(0, key.size() - kEnding.size())] = value;
  }
  return out;
}

VehicleSources load_vehicle_sources(const std::string& path) {
  return parse_vehicle_sources(read_text_file(path), path);
}

std::string vehicle_text(const plant::Vehicle& vehicle, const VehicleSources& sources,
                         const plant::VehicleUncertainty& uncertainty, const std::string& comment) {
  const Writer writer(sources);
  std::ostringstream out;
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) out << "# " << line << '\n';
  out << "name: " << quoted(vehicle.name) << "\n\nmass: " << writer.quantity("mass", vehicle.mass_kg, "kg")
      << '\n';
  write_inertia(out, vehicle.inertia, writer);
  out << "linear_drag: " << writer.quantity("linear_drag", vehicle.linear_drag, "N*s/m") << '\n';
  write_rotors(out, vehicle.rotors, writer);
  out << "rotor:\n  thrust_factor: " << writer.quantity("rotor.thrust_factor", vehicle.rotor.thrust, "N*s^2")
      << "\n  torque_factor: " << writer.quantity("rotor.torque_factor", vehicle.rotor.torque, "N*m*s^2")
      << '\n';
  write_motor(out, vehicle.motor, writer);
  write_esc(out, vehicle.esc, writer);
  write_battery(out, vehicle.battery, writer);
  write_uncertainty(out, uncertainty);
  return out.str();
}

}  // namespace swiftlet::io
