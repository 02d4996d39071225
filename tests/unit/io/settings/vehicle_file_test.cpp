#include "swiftlet/io/settings/vehicle_file.hpp"

#include <algorithm>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

#include "swiftlet/io/text_file.hpp"
#include "swiftlet/plant/model/rotor.hpp"
#include "tests/support/paths.hpp"
#include "tests/unit/io/config_error_check.hpp"

namespace swiftlet::io::vehicle_file_test {

using plant::Vehicle;
using tests::refusal;

const std::string& kaylion_text() {
  static const std::string text = read_text_file(tests::in_source("config/vehicles/kaylion.yaml"));
  return text;
}

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = kaylion_text();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// The number of the first line that contains a text.
std::string line_of(const std::string& text, const std::string& part) {
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return std::to_string(1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

// All parameters of a vehicle, for comparisons.
std::vector<double> numbers(const Vehicle& v) {
  std::vector<double> out = {v.mass_kg, v.linear_drag};
  out.insert(out.end(), v.inertia.data(), v.inertia.data() + 9);
  for (const plant::RotorMount& mount : v.rotors) {
    out.insert(out.end(), mount.position_frd.data(), mount.position_frd.data() + 3);
    out.push_back(static_cast<double>(mount.spin));
  }
  for (const double x :
       {v.rotor.thrust, v.rotor.torque, static_cast<double>(v.motor.model), v.motor.time_constant_s,
        v.motor.k2, v.motor.k3, v.motor.armature_resistance_ohm, v.motor.armature_inductance_h, v.esc.gain,
        v.esc.offset_v2, v.esc.pulse_min_us, v.esc.pulse_range_us, v.battery.capacity_ah,
        v.battery.internal_resistance_ohm, v.battery.sag_time_constant_s, v.battery.electronics_current_a}) {
    out.push_back(x);
  }
  out.insert(out.end(), v.battery.state_of_charge.begin(), v.battery.state_of_charge.end());
  out.insert(out.end(), v.battery.open_circuit_voltage_v.begin(), v.battery.open_circuit_voltage_v.end());
  return out;
}

TEST(VehicleFile, KayLionHasTheIdentifiedParameters) {
  const Vehicle v = load_vehicle(tests::in_source("config/vehicles/kaylion.yaml"));
  EXPECT_EQ(v.name, "kaylion");
  EXPECT_EQ(v.mass_kg, 0.040);
  EXPECT_EQ(v.inertia, Eigen::Matrix3d(Eigen::Vector3d(4.4e-5, 4.5e-5, 8.8e-5).asDiagonal()));
  ASSERT_EQ(v.rotor_count(), 4);
  EXPECT_NEAR(v.rotors[0].position_frd.norm(), 0.0695, 1e-15);
  EXPECT_EQ(v.rotors[1].spin, plant::Spin::kClockwise);
  EXPECT_EQ(v.rotor.thrust, 3.7901e-8);
  EXPECT_EQ(v.rotor.torque, 1.8623e-10);
  EXPECT_EQ(v.motor.model, plant::MotorModel::kReduced);
  EXPECT_EQ(v.motor.time_constant_s, 0.0821);
  EXPECT_EQ(v.motor.k2, 1.020e-3);
  EXPECT_EQ(v.motor.k3, 2.817e-7);
  EXPECT_EQ(v.esc.gain, 0.9205);
  EXPECT_EQ(v.esc.offset_v2, 0.6472);
  EXPECT_EQ(v.esc.pulse_min_us, 1039.0);
  EXPECT_EQ(v.esc.pulse_range_us, 1000.0);
  EXPECT_EQ(v.battery.open_circuit_voltage_v.back(), 4.19);
}

TEST(VehicleFile, EveryParameterNamesItsSource) {
  std::size_t quantities = 0;
  for (std::size_t at = kaylion_text().find("value:"); at != std::string::npos;
       at = kaylion_text().find("value:", at + 1)) {
    ++quantities;
    const std::size_t source = kaylion_text().find("source: ", at);
    const std::string text = kaylion_text().substr(source, kaylion_text().find('\n', source) - source);
    EXPECT_TRUE(text.find("Eq. (") != std::string::npos || text.find("estimate") != std::string::npos ||
                text.find("Section IV") != std::string::npos)
        << text;
  }
  EXPECT_GT(quantities, 20U);
}

struct Fault {
  const char* name;
  const char* from;  // text in kaylion.yaml
  const char* to;
  const char* at;  // text in the line that the message names
  const char* message;
};
void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

class Faults : public testing::TestWithParam<Fault> {};

TEST_P(Faults, AreNamedWithLineKeyValueAndLimit) {
  const Fault& fault = GetParam();
  const std::string text = replaced(fault.from, fault.to);
  EXPECT_EQ(refusal([&] { parse_vehicle(text, "v.yaml"); }),
            "v.yaml:" + line_of(text, fault.at) + ": " + fault.message);
}

const Fault kFaults[] = {
    {"Range", "value: 0.040", "value: -1", "mass:", "mass: is -1, must be a finite number above 0"},
    {"Nan", "value: 0.040", "value: .nan", "mass:", "mass.value: is .nan, must be a finite number"},
    {"Unit", "unit: kg,", "unit: g,", "mass:", "mass.unit: is g, must be kg"},
    {"UnitMissing", "unit: kg,", "", "mass:", "mass.unit: is missing, must be given"},
    {"SourceMissing", ", source: \"Eq. (18)\"", "",
     "time_constant:", "motor.time_constant.source: is missing, must be given"},
    {"BareNumber", "{value: 0.0821, unit: s, source: \"Eq. (18)\"}", "0.0821",
     "time_constant:", "motor.time_constant: is 0.0821, must be a map {value, unit, source}"},
    {"Misspelt", "linear_drag:", "linear_darg:", "linear_darg:",
     "linear_darg: is unknown, must be one of name, mass, inertia, linear_drag, rotors, rotor, motor, esc, "
     "battery or uncertainty; nearest is linear_drag"},
    {"MassMisspelt", "mass:", "masss:", "masss:",
     "masss: is unknown, must be one of name, mass, inertia, linear_drag, rotors, rotor, motor, esc, battery "
     "or "
     "uncertainty; nearest is mass"},
    {"ArmInMillimetres", "[0.04914392129246505, 0.04914392129246505, 0]", "[49.1, 49.1, 0]",
     "[49.1, 49.1, 0]",
     "rotors[0].position_frd: is 69.4379 m, which is implausible: the mass over the longest arm cubed, in "
     "kg/m^3, is 1.19473e-07, must be between 0.5 and 50000; mm entered as m?"},
    {"Unknown", "name: kaylion", "name: kaylion\ncolour: red", "colour",
     "colour: is unknown, must be one of name, mass, inertia, linear_drag, rotors, rotor, motor, esc, "
     "battery or uncertainty"},
    {"Duplicate", "name: kaylion", "name: kaylion\nname: other", "name: other",
     "name: is given twice, first in line 5"},
    {"Spin", "spin: clockwise", "spin: left", "spin: left",
     "rotors[1].spin: is left, must be counter_clockwise or clockwise"},
    {"Model", "  model: reduced", "  model: exact", "model: exact",
     "motor.model: is exact, must be reduced or physical"},
    {"InertiaRow", "[0, 4.5e-5, 0]", "[0, 4.5e-5]", "[0, 4.5e-5]",
     "inertia.value[1]: is a list of 2, must be a list of 3"},
    {"InertiaTriangle", "[0, 0, 8.8e-5]", "[0, 0, 9.8e-5]", "inertia:\n",
     "inertia: has the principal moment 9.8e-05, must be at most the sum of the others, 8.9e-05"},
    {"Curve", "[2.65, 2.96,", "[2.65,", "voltage:\n",
     "battery.open_circuit.voltage: is a list of 11, must have one value for each of the 12 states of "
     "charge"},
    {"RotorKeysMixed", "  torque_factor: {value: 1.8623e-10, unit: N*m*s^2, source: \"Eq. (26)\"}", "",
     "rotor:\n", "rotor.torque_factor: is missing, must be given"},
};

INSTANTIATE_TEST_SUITE_P(Vehicle, Faults, testing::ValuesIn(kFaults),
                         [](const auto& fault) { return fault.param.name; });

TEST(VehicleFile, AcceptsBladeCoefficients) {
  const plant::BladeCoefficients blade = plant::blade_coefficients({3.7901e-8, 1.8623e-10}, 0.0275, 1.2);
  std::ostringstream rotor;
  rotor.precision(17);
  rotor << "rotor:\n"
        << "  thrust_coefficient: {value: " << blade.thrust << ", unit: 1, source: bench}\n"
        << "  torque_coefficient: {value: " << blade.torque << ", unit: 1, source: bench}\n"
        << "  radius: {value: 0.0275, unit: m, source: ruler}\n"
        << "  air_density: {value: 1.2, unit: kg/m^3, source: estimate}\n";
  const std::size_t begin = kaylion_text().find("rotor:\n");
  const std::size_t end = kaylion_text().find("\n\n", begin);
  std::string text = kaylion_text();
  text.replace(begin, end + 1 - begin, rotor.str());
  const Vehicle vehicle = parse_vehicle(text, "v.yaml");
  EXPECT_NEAR(vehicle.rotor.thrust / 3.7901e-8, 1.0, 1e-12);
  EXPECT_NEAR(vehicle.rotor.torque / 1.8623e-10, 1.0, 1e-12);
}

TEST(VehicleFile, RefusesEveryTruncation) {
  const std::string& text = kaylion_text();
  for (std::size_t length = 0; length < text.size(); ++length) {
    EXPECT_THROW(parse_vehicle(text.substr(0, length), "v.yaml"), ConfigError) << length;
  }
}

TEST(VehicleFile, RequiresEveryKey) {
  // No key falls back to a default.
  const std::string& text = kaylion_text();
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin) + 1;
    const std::string line = text.substr(begin, end - begin);
    const std::size_t first = line.find_first_not_of(' ');
    if (line[first] != '#' && line[first] != '\n') {
      std::string without = text;
      without.erase(begin, end - begin);
      EXPECT_THROW(parse_vehicle(without, "v.yaml"), ConfigError) << line;
    }
    begin = end;
  }
}

TEST(VehicleFile, MutatedFilesAreRefusedOrLoadAValidVehicle) {
  std::mt19937 generator(11);
  const std::string& text = kaylion_text();
  int refused = 0;
  int loaded = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string mutated = text;
    for (int k = 0; k < 1 + i % 4; ++k) {
      const std::size_t at = generator() % text.size();
      // Half of the bytes are printable: those get further into the loader.
      mutated[at] = static_cast<char>(i % 2 == 0 ? generator() % 256 : 0x20 + generator() % 95);
    }
    try {
      const Vehicle vehicle = parse_vehicle(mutated, "v.yaml");
      EXPECT_TRUE(plant::validate(vehicle).empty());
      ++loaded;
    } catch (const ConfigError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("v.yaml", 0), 0U);
      ++refused;
    }
  }
  EXPECT_GT(refused, 500);
  EXPECT_GT(loaded, 100);
}

TEST(VehicleFile, IgnoresCommentsAndBlankLines) {
  std::string flow;
  for (const char c : kaylion_text()) {
    flow += c;
    if (c == '\n') flow += "# comment\n\n";
  }
  EXPECT_EQ(numbers(parse_vehicle(flow, "v.yaml")), numbers(parse_vehicle(kaylion_text(), "v.yaml")));
}

}  // namespace swiftlet::io::vehicle_file_test
