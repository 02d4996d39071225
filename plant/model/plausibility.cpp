#include "swiftlet/plant/model/plausibility.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "swiftlet/plant/model/propulsion.hpp"

namespace swiftlet::plant {
namespace {

constexpr double kSecondsPerHour = 3600.0;

// A ratio of parameters: KayLion, the Crazyflie 2.0 and vehicles of 10 kg lie well inside its limits.
struct Ratio {
  const char* name;
  double least;
  double usual;
  double most;

  bool allows(double value) const { return value >= least && value <= most; }
};
constexpr Ratio kSupply = {"the full voltage in V", 0.5, 10.0, 200.0};
constexpr Ratio kDensity = {"the mass over the longest arm cubed, in kg/m^3,", 0.5, 100.0, 5e4};
constexpr Ratio kGyration = {"the radius of gyration over the longest arm", 0.05, 0.7, 5.0};
constexpr Ratio kThrust = {"the full thrust over the weight", 0.1, 2.5, 50.0};
constexpr Ratio kTorque = {"the torque over thrust and longest arm", 1e-3, 0.1, 2.0};
constexpr Ratio kLag = {"the time constant over sqrt(longest arm / g)", 0.01, 0.7, 20.0};
constexpr Ratio kEnergy = {"the energy of the battery over the mass, in J/kg,", 1e3, 1e5, 2e6};
constexpr Ratio kElectronics = {"the current over the capacity, in 1/h,", 0.0, 0.5, 50.0};
constexpr Ratio kSag = {"the sag at a discharge in 1 h over the full voltage", 0.0, 5e-3, 0.5};

// A unit that may have been meant instead of the file's.
struct Unit {
  const char* name;
  double factor;  // to the unit of the file
};

struct Parameter {
  std::string key;
  double value;
  const char* unit;
  std::vector<Unit> others;
  double power = 1.0;  // of the value in the ratio
};

// "; mm entered as m?" for the unit with which the ratio is the most usual; "" if none makes it plausible.
std::string suspicion(const Parameter& parameter, const Ratio& ratio, double value) {
  const auto with = [&](const Unit& unit) { return value * std::pow(unit.factor, parameter.power); };
  const auto off = [&](const Unit& unit) { return std::abs(std::log(with(unit) / ratio.usual)); };
  const auto meant = std::min_element(parameter.others.begin(), parameter.others.end(),
                                      [&](const Unit& a, const Unit& b) { return off(a) < off(b); });
  if (meant == parameter.others.end() || !ratio.allows(with(*meant))) return "";
  return std::string("; ") + meant->name + " entered as " + parameter.unit + "?";
}

// Leaves values that are no positive numbers to validate().
void check_ratio(const Parameter& parameter, const Ratio& ratio, double value, RuleChecker& check) {
  if (!std::isfinite(value) || value <= 0.0 || ratio.allows(value)) return;
  check.add(parameter.key, "is ", parameter.value, ' ', parameter.unit,
            ", which is implausible: ", ratio.name, " is ", value, ", must be between ", ratio.least, " and ",
            ratio.most, suspicion(parameter, ratio, value));
}

struct Arm {
  std::size_t rotor = 0;
  double length_m = 0.0;
};

Arm longest_arm(const Vehicle& vehicle) {
  Arm longest;
  for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
    const double length_m = vehicle.rotors[i].position_frd.norm();
    if (length_m > longest.length_m) longest = {i, length_m};
  }
  return longest;
}

void check_battery(const Vehicle& vehicle, double full_v, RuleChecker& check) {
  const BatteryParameters& battery = vehicle.battery;
  check_ratio({"battery.capacity", battery.capacity_ah, "A*h", {{"mA*h", 1e-3}}}, kEnergy,
              battery.capacity_ah * full_v * kSecondsPerHour / vehicle.mass_kg, check);
  check_ratio({"battery.electronics_current", battery.electronics_current_a, "A", {{"mA", 1e-3}}},
              kElectronics, battery.electronics_current_a / battery.capacity_ah, check);
  check_ratio({"battery.internal_resistance", battery.internal_resistance_ohm, "ohm", {{"mohm", 1e-3}}}, kSag,
              battery.internal_resistance_ohm * battery.capacity_ah / full_v, check);
}

}  // namespace

std::vector<Violation> implausible(const Vehicle& vehicle) {
  RuleChecker check;
  if (vehicle.rotors.empty() || vehicle.battery.open_circuit_voltage_v.empty()) return {};
  const double mass_kg = vehicle.mass_kg;
  const double full_v = vehicle.battery.open_circuit_voltage_v.back();
  const Arm arm = longest_arm(vehicle);
  check_ratio({"battery.open_circuit.voltage", full_v, "V", {{"mV", 1e-3}}}, kSupply, full_v, check);
  const double density = mass_kg / std::pow(arm.length_m, 3);
  if (density < kDensity.least) {
    check_ratio({"rotors[" + std::to_string(arm.rotor) + "].position_frd",
                 arm.length_m,
                 "m",
                 {{"mm", 1e-3}, {"cm", 1e-2}, {"inches", 0.0254}},
                 -3.0},
                kDensity, density, check);
  } else {
    check_ratio({"mass", mass_kg, "kg", {{"g", 1e-3}}}, kDensity, density, check);
  }
  if (vehicle.inertia.allFinite()) {
    const double greatest = vehicle.inertia.diagonal().maxCoeff();
    check_ratio({"inertia",
                 greatest,
                 "kg*m^2",
                 {{"g*m^2", 1e-3}, {"kg*cm^2", 1e-4}, {"kg*mm^2", 1e-6}, {"g*cm^2", 1e-7}, {"g*mm^2", 1e-9}},
                 0.5},
                kGyration, std::sqrt(greatest / mass_kg) / arm.length_m, check);
  }
  const double full_thrust_n = vehicle.rotor_count() * steady_thrust_range(vehicle, full_v).max;
  check_ratio({"rotor.thrust_factor", vehicle.rotor.thrust, "N*s^2", {{"gf*s^2", 1e-3 * kGravity}}}, kThrust,
              full_thrust_n / (mass_kg * kGravity), check);
  check_ratio({"rotor.torque_factor", vehicle.rotor.torque, "N*m*s^2", {{"N*mm*s^2", 1e-3}}}, kTorque,
              vehicle.rotor.torque / (vehicle.rotor.thrust * arm.length_m), check);
  check_ratio({"motor.time_constant", vehicle.motor.time_constant_s, "s", {{"ms", 1e-3}}}, kLag,
              vehicle.motor.time_constant_s / std::sqrt(arm.length_m / kGravity), check);
  check_battery(vehicle, full_v, check);
  return check.take();
}

}  // namespace swiftlet::plant
