#include "swiftlet/plant/model/plausibility.hpp"

#include <functional>
#include <limits>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::io::plausibility_test {

plant::Vehicle shipped(const std::string& name) {
  return io::load_vehicle(tests::in_source("config/vehicles/") + name + ".yaml");
}

// A vehicle of 10 kg with arms of half a metre.
plant::Vehicle large() {
  plant::Vehicle vehicle = shipped("kaylion");
  vehicle.mass_kg = 10.0;
  vehicle.inertia = Eigen::Vector3d(0.3, 0.3, 0.5).asDiagonal();
  for (plant::RotorMount& mount : vehicle.rotors) mount.position_frd *= 0.5 / 0.0695;
  vehicle.rotor = {3e-4, 8e-6};
  vehicle.motor.k2 = 0.03;
  vehicle.motor.k3 = 1e-5;
  vehicle.motor.armature_resistance_ohm = 0.03;
  vehicle.esc.offset_v2 = 0.0;
  vehicle.battery.capacity_ah = 20.0;
  vehicle.battery.internal_resistance_ohm = 0.01;
  vehicle.battery.electronics_current_a = 2.0;
  for (double& voltage : vehicle.battery.open_circuit_voltage_v) voltage *= 6.0;
  return vehicle;
}

TEST(Plausibility, HoldsForVehiclesOfAllSizes) {
  for (const plant::Vehicle& vehicle : {shipped("kaylion"), shipped("crazyflie2"), large()}) {
    EXPECT_TRUE(plant::validate(vehicle).empty()) << vehicle.mass_kg;
    for (const plant::Violation& violation : plant::implausible(vehicle))
      ADD_FAILURE() << violation.key << violation.message;
  }
}

struct Mistake {
  const char* name;
  std::function<void(plant::Vehicle&)> make;
  const char* key;
  const char* suspicion;
};
void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class Mistakes : public testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, AreSuspectedByTheirUnit) {
  for (const plant::Vehicle& right : {shipped("kaylion"), shipped("crazyflie2"), large()}) {
    plant::Vehicle vehicle = right;
    GetParam().make(vehicle);
    const std::vector<plant::Violation> found = plant::implausible(vehicle);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found.front().key, GetParam().key);
    EXPECT_NE(found.front().message.find(GetParam().suspicion), std::string::npos) << found.front().message;
  }
}

const Mistake kMistakes[] = {
    {"ArmsInMillimetres",
     [](plant::Vehicle& v) {
       for (plant::RotorMount& mount : v.rotors) mount.position_frd *= 1e3;
     },
     "rotors[0].position_frd", "; mm entered as m?"},
    {"InertiaInGramsTimesSquareCentimetres", [](plant::Vehicle& v) { v.inertia *= 1e7; }, "inertia",
     "; g*cm^2 entered as kg*m^2?"},
    {"TimeConstantInMilliseconds", [](plant::Vehicle& v) { v.motor.time_constant_s *= 1e3; },
     "motor.time_constant", "; ms entered as s?"},
    {"CapacityInMilliamperes", [](plant::Vehicle& v) { v.battery.capacity_ah *= 1e3; }, "battery.capacity",
     "; mA*h entered as A*h?"},
    {"CurrentInMilliamperes", [](plant::Vehicle& v) { v.battery.electronics_current_a *= 1e3; },
     "battery.electronics_current", "; mA entered as A?"},
    {"ResistanceInMilliohms", [](plant::Vehicle& v) { v.battery.internal_resistance_ohm *= 1e3; },
     "battery.internal_resistance", "; mohm entered as ohm?"},
    {"TorqueInNewtonMillimetres", [](plant::Vehicle& v) { v.rotor.torque *= 1e3; }, "rotor.torque_factor",
     "; N*mm*s^2 entered as N*m*s^2?"},
    {"ThrustInGrams", [](plant::Vehicle& v) { v.rotor.thrust *= 1e3 / plant::kGravity; },
     "rotor.thrust_factor", "; gf*s^2 entered as N*s^2?"},
    {"VoltageInMillivolts",
     [](plant::Vehicle& v) {
       for (double& voltage : v.battery.open_circuit_voltage_v) voltage *= 1e3;
     },
     "battery.open_circuit.voltage", "; mV entered as V?"},
};
INSTANTIATE_TEST_SUITE_P(Units, Mistakes, testing::ValuesIn(kMistakes),
                         [](const auto& mistake) { return mistake.param.name; });

TEST(Plausibility, SuspectsGramsOfAMicroVehicle) {
  plant::Vehicle vehicle = shipped("crazyflie2");
  vehicle.mass_kg = 27.0;
  ASSERT_FALSE(plant::implausible(vehicle).empty());
  EXPECT_EQ(
      plant::implausible(vehicle).front().message,
      "is 27 kg, which is implausible: the mass over the longest arm cubed, in kg/m^3, is 277390, must be "
      "between 0.5 and 50000; g entered as kg?");
}

TEST(Plausibility, LeavesInvalidValuesToTheOtherRules) {
  plant::Vehicle vehicle = shipped("kaylion");
  vehicle.mass_kg = std::numeric_limits<double>::quiet_NaN();
  vehicle.rotor.thrust = -1.0;
  vehicle.motor.time_constant_s = 0.0;
  EXPECT_TRUE(plant::implausible(vehicle).empty());
  EXPECT_TRUE(plant::implausible(plant::Vehicle()).empty());
}

}  // namespace swiftlet::io::plausibility_test
