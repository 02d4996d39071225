#include "swiftlet/plant/model/vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "swiftlet/math/linear_algebra.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/propulsion.hpp"
#include "swiftlet/plant/model/setting_values.hpp"
#include "swiftlet/plant/model/vehicle_visit.hpp"

namespace swiftlet::plant {

namespace {

constexpr double kMinElectricalTimeConstant = 1e-6;  // s, L_a / R_a; for the same reason
constexpr double kMinHubDistance = 1e-3;             // m, between two hubs
constexpr double kMinSingularValue = 1e-3;           // of the effectiveness with rows scaled to length 1
constexpr double kSymmetry = 1e-9;                   // relative tolerance

std::string rotor_key(std::size_t index, const char* name) {
  return "rotors[" + std::to_string(index) + "]." + name;
}

bool check_inertia(const Eigen::Matrix3d& inertia, RuleChecker& check) {
  const char* const key = "inertia";
  if (!inertia.allFinite()) {
    check.add(key, "holds a value that is not finite");
    return false;
  }
  if ((inertia - inertia.transpose()).cwiseAbs().maxCoeff() > kSymmetry * inertia.cwiseAbs().maxCoeff()) {
    check.add(key, "is not symmetric, must be symmetric");
    return false;
  }
  const Eigen::Vector3d principal = math::symmetric_eigen(inertia).values;  // in ascending order
  if (!(principal[0] > 0.0)) {
    check.add(key, "has the principal moment ", principal[0], ", must be above 0");
    return false;
  }
  const double sum = principal[0] + principal[1];
  if (!(principal[2] <= sum * (1.0 + kSymmetry))) {
    check.add(key, "has the principal moment ", principal[2], ", must be at most the sum of the others, ",
              sum);
    return false;
  }
  return true;
}

bool check_rotors(const std::vector<RotorMount>& rotors, RuleChecker& check) {
  if (rotors.size() < static_cast<std::size_t>(kMinRotors) ||
      rotors.size() > static_cast<std::size_t>(kMaxRotors)) {
    check.add("rotors", "is a list of ", rotors.size(), ", must be a list of ", kMinRotors, " to ",
              kMaxRotors);
    return false;
  }
  bool holds = true;
  for (std::size_t i = 0; i < rotors.size(); ++i) {
    if (!rotors[i].position_frd.allFinite()) {
      check.add(rotor_key(i, "position_frd"), "holds a value that is not finite");
      holds = false;
    }
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = (rotors[i].position_frd - rotors[j].position_frd).norm();
      if (distance < kMinHubDistance) {
        check.add(rotor_key(i, "position_frd"), "is ", distance, " m from that of rotors[", j,
                  "], must be at least ", kMinHubDistance);
        holds = false;
      }
    }
  }
  return holds;
}

bool check_motor(const Vehicle& vehicle, RuleChecker& check) {
  const Motor& motor = vehicle.motor;
  const double max_resistance = motor.k2 * motor.k3 / vehicle.rotor.torque;
  if (!(motor.armature_resistance_ohm <= max_resistance)) {
    check.add("motor.armature_resistance", "is ", motor.armature_resistance_ohm,
              ", must be at most K2 K3 / k_Q = ", max_resistance,
              ", for which the friction of Eq. (21) is 0");
    return false;
  }
  const double min_inductance = kMinElectricalTimeConstant * motor.armature_resistance_ohm;
  if (motor.armature_inductance_h > 0.0 && motor.armature_inductance_h < min_inductance) {
    check.add("motor.armature_inductance", "is ", motor.armature_inductance_h,
              ", must be 0 (no electrical lag) or at least 1 us times R_a = ", min_inductance);
    return false;
  }
  return true;
}

bool is_strictly_rising(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), [](double a, double b) { return !(a < b); }) ==
         values.end();
}

bool check_battery(const BatteryParameters& battery, RuleChecker& check) {
  bool holds = true;
  const std::vector<double>& soc = battery.state_of_charge;
  const std::vector<double>& voltage = battery.open_circuit_voltage_v;
  if (soc.size() < 2 || soc.front() != 0.0 || soc.back() != 1.0 || !is_strictly_rising(soc)) {
    check.add("battery.open_circuit.state_of_charge", "must rise from 0 to 1");
    holds = false;
  }
  if (voltage.size() != soc.size()) {
    check.add("battery.open_circuit.voltage", "is a list of ", voltage.size(),
              ", must have one value for each of the ", soc.size(), " states of charge");
    holds = false;
  } else if (voltage.empty() || !(voltage.front() > 0.0) || !std::isfinite(voltage.back()) ||
             !is_strictly_rising(voltage)) {
    check.add("battery.open_circuit.voltage", "must be above 0, finite and rising");
    holds = false;
  }
  return holds;
}

// Checks that thrust, roll, pitch and yaw can be commanded independently.
bool check_authority(const Vehicle& vehicle, RuleChecker& check) {
  if (least_authority(effectiveness(vehicle)) > kMinSingularValue) return true;
  check.add("rotors",
            "must produce thrust, roll, pitch and yaw independently: Eq. (27) and (28) have rank below 4");
  return false;
}

void check_hover(const Vehicle& vehicle, RuleChecker& check) {
  const double full = vehicle.battery.open_circuit_voltage_v.back();
  const ThrustRange range = steady_thrust_range(vehicle, full);
  const double max_mass = vehicle.rotor_count() * range.max / kGravity;
  const double min_mass = vehicle.rotor_count() * range.min / kGravity;
  if (!(vehicle.mass_kg < max_mass)) {
    check.add("mass", "is ", vehicle.mass_kg, ", must be below ", max_mass, ", which throttle 1 at ", full,
              " V can lift");
    return;
  }
  if (!(vehicle.mass_kg > min_mass)) {
    check.add("mass", "is ", vehicle.mass_kg, ", must be above ", min_mass, ", which throttle 0 at ", full,
              " V lifts already");
    return;
  }
  const RotorThrusts trim = trim_thrusts(vehicle);
  for (int i = 0; i < vehicle.rotor_count(); ++i) {
    if (trim[i] > range.min && trim[i] < range.max) continue;
    check.add(rotor_key(static_cast<std::size_t>(i), "position_frd"), "requires a thrust of ", trim[i],
              " N in hover, must be between ", range.min, " and ", range.max, " (throttle 0 and 1 at ", full,
              " V)");
  }
}

}  // namespace

std::vector<Violation> validate(const Vehicle& vehicle) {
  RuleChecker check;
  if (vehicle.name.empty()) check.add("name", "is empty, must be given");
  bool holds = check_settings(vehicle, check);
  holds = holds && check_motor(vehicle, check);
  holds = check_inertia(vehicle.inertia, check) && holds;
  holds = check_rotors(vehicle.rotors, check) && holds;
  holds = check_battery(vehicle.battery, check) && holds;
  if (holds && check_authority(vehicle, check)) check_hover(vehicle, check);
  return check.take();
}

}  // namespace swiftlet::plant
