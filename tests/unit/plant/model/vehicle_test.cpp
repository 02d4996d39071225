#include "swiftlet/plant/model/vehicle.hpp"

#include <functional>
#include <limits>
#include <ostream>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::plant::vehicle_test {

using tests::kaylion;
using tests::multirotor;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Validate, AcceptsKayLion) { EXPECT_TRUE(validate(kaylion()).empty()); }

TEST(Validate, AcceptsEvenMultirotors) {
  for (const int count : {4, 6, 8}) EXPECT_TRUE(validate(multirotor(count)).empty()) << count;
}

struct Rule {
  const char* name;
  std::function<void(Vehicle&)> break_it;
  const char* key;
  const char* message;  // part of it
};

void PrintTo(const Rule& rule, std::ostream* out) { *out << rule.name; }

class Rules : public testing::TestWithParam<Rule> {};

TEST_P(Rules, AreReportedWithKeyValueAndLimit) {
  Vehicle vehicle = kaylion();
  GetParam().break_it(vehicle);
  const std::vector<Violation> violations = validate(vehicle);
  ASSERT_FALSE(violations.empty());
  EXPECT_EQ(violations[0].key, GetParam().key);
  EXPECT_NE(violations[0].message.find(GetParam().message), std::string::npos) << violations[0].message;
}

const Rule kRules[] = {
    {"Name", [](Vehicle& v) { v.name.clear(); }, "name", "is empty"},
    {"MassZero", [](Vehicle& v) { v.mass_kg = 0.0; }, "mass", "is 0, must be a finite number above 0"},
    {"MassNan", [](Vehicle& v) { v.mass_kg = kNan; }, "mass", "is nan, must be a finite number above 0"},
    {"MassInfinite", [](Vehicle& v) { v.mass_kg = kInfinity; }, "mass", "is inf"},
    {"MassInGrams", [](Vehicle& v) { v.mass_kg = 40.0; }, "mass", "is 40, must be below 0.0899"},
    {"MassBelowIdleThrust", [](Vehicle& v) { v.mass_kg = 0.005; }, "mass", "is 0.005, must be above 0.0068"},
    {"InertiaNan", [](Vehicle& v) { v.inertia(1, 2) = kNan; }, "inertia", "not finite"},
    {"InertiaAsymmetric", [](Vehicle& v) { v.inertia(0, 1) = 1e-6; }, "inertia", "is not symmetric"},
    {"InertiaZero", [](Vehicle& v) { v.inertia.setZero(); }, "inertia",
     "has the principal moment 0, must be above 0"},
    {"InertiaNegative", [](Vehicle& v) { v.inertia(0, 0) = -1e-5; }, "inertia", "principal moment -1e-05"},
    {"InertiaTriangle", [](Vehicle& v) { v.inertia(2, 2) = 1e-4; }, "inertia",
     "has the principal moment 0.0001, must be at most the sum of the others, 8.9e-05"},
    {"DragNegative", [](Vehicle& v) { v.linear_drag = -0.1; }, "linear_drag",
     "is -0.1, must be a finite number of at least 0"},
    {"TooFewRotors", [](Vehicle& v) { v.rotors.resize(3); }, "rotors",
     "is a list of 3, must be a list of 4 to 8"},
    {"TooManyRotors", [](Vehicle& v) { v.rotors.resize(9); }, "rotors",
     "is a list of 9, must be a list of 4 to 8"},
    {"NoRotors", [](Vehicle& v) { v.rotors.clear(); }, "rotors", "is a list of 0"},
    {"RotorNan", [](Vehicle& v) { v.rotors[2].position_frd.x() = kNan; }, "rotors[2].position_frd",
     "not finite"},
    {"CoincidentRotors", [](Vehicle& v) { v.rotors[3].position_frd = v.rotors[1].position_frd; },
     "rotors[3].position_frd", "is 0 m from that of rotors[1], must be at least 0.001"},
    {"NoYaw",
     [](Vehicle& v) {
       for (RotorMount& m : v.rotors) m.spin = Spin::kClockwise;
     },
     "rotors", "rank below 4"},
    {"YawTiedToPitch",
     [](Vehicle& v) {
       for (std::size_t i = 0; i < 4; ++i)
         v.rotors[i].spin = i < 2 ? Spin::kClockwise : Spin::kCounterClockwise;
     },
     "rotors", "rank below 4"},
    {"NoRoll",
     [](Vehicle& v) {
       for (std::size_t i = 0; i < 4; ++i)
         v.rotors[i].position_frd = {0.05 * static_cast<double>(i) - 0.1, 0, 0};
     },
     "rotors", "rank below 4"},
    {"CentreOfMassOutsideTheRotors",
     [](Vehicle& v) {
       for (RotorMount& m : v.rotors) m.position_frd.x() += 0.06;
     },
     "rotors[0].position_frd", "requires a thrust of -"},
    {"ThrustFactor", [](Vehicle& v) { v.rotor.thrust = 0.0; }, "rotor.thrust_factor", "above 0"},
    {"TorqueFactor", [](Vehicle& v) { v.rotor.torque = -1e-10; }, "rotor.torque_factor", "is -1e-10"},
    {"TimeConstant", [](Vehicle& v) { v.motor.time_constant_s = 1e-4; }, "motor.time_constant",
     "is 0.0001, must be a finite number of at least 0.001"},
    {"K2", [](Vehicle& v) { v.motor.k2 = 0.0; }, "motor.k2", "above 0"},
    {"K3", [](Vehicle& v) { v.motor.k3 = kNan; }, "motor.k3", "is nan"},
    {"Resistance", [](Vehicle& v) { v.motor.armature_resistance_ohm = 0.0; }, "motor.armature_resistance",
     "above 0"},
    {"NegativeFriction", [](Vehicle& v) { v.motor.armature_resistance_ohm = 1.6; },
     "motor.armature_resistance", "is 1.6, must be at most K2 K3 / k_Q = 1.5429"},
    {"Inductance", [](Vehicle& v) { v.motor.armature_inductance_h = -1.0; }, "motor.armature_inductance",
     "at least 0"},
    {"EscGain", [](Vehicle& v) { v.esc.gain = 0.0; }, "esc.gain", "above 0"},
    {"EscOffset", [](Vehicle& v) { v.esc.offset_v2 = kInfinity; }, "esc.offset",
     "is inf, must be a finite number"},
    {"PulseMin", [](Vehicle& v) { v.esc.pulse_min_us = -1.0; }, "esc.pulse_min", "at least 0"},
    {"PulseRange", [](Vehicle& v) { v.esc.pulse_range_us = 0.0; }, "esc.pulse_range", "above 0"},
    {"Capacity", [](Vehicle& v) { v.battery.capacity_ah = 0.0; }, "battery.capacity", "above 0"},
    {"InternalResistance", [](Vehicle& v) { v.battery.internal_resistance_ohm = -0.1; },
     "battery.internal_resistance", "at least 0"},
    {"SagTime", [](Vehicle& v) { v.battery.sag_time_constant_s = 0.0; }, "battery.sag_time_constant",
     "at least 0.001"},
    {"Electronics", [](Vehicle& v) { v.battery.electronics_current_a = kNan; }, "battery.electronics_current",
     "is nan"},
    {"ChargeFromZero", [](Vehicle& v) { v.battery.state_of_charge.front() = 0.01; },
     "battery.open_circuit.state_of_charge", "must rise from 0 to 1"},
    {"ChargeToOne", [](Vehicle& v) { v.battery.state_of_charge.back() = 0.99; },
     "battery.open_circuit.state_of_charge", "must rise from 0 to 1"},
    {"ChargeRises", [](Vehicle& v) { v.battery.state_of_charge[2] = v.battery.state_of_charge[1]; },
     "battery.open_circuit.state_of_charge", "must rise from 0 to 1"},
    {"ChargeEmpty", [](Vehicle& v) { v.battery.state_of_charge.clear(); },
     "battery.open_circuit.state_of_charge", "must rise from 0 to 1"},
    {"VoltageCount", [](Vehicle& v) { v.battery.open_circuit_voltage_v.pop_back(); },
     "battery.open_circuit.voltage", "is a list of 11, must have one value for each of the 12"},
    {"VoltageRises", [](Vehicle& v) { v.battery.open_circuit_voltage_v[3] = 3.0; },
     "battery.open_circuit.voltage", "must be above 0, finite and rising"},
    {"VoltageNan", [](Vehicle& v) { v.battery.open_circuit_voltage_v[3] = kNan; },
     "battery.open_circuit.voltage", "must be above 0, finite and rising"},
};

INSTANTIATE_TEST_SUITE_P(Vehicle, Rules, testing::ValuesIn(kRules),
                         [](const auto& rule) { return rule.param.name; });

TEST(Validate, ListsAllViolations) {
  Vehicle vehicle = kaylion();
  vehicle.mass_kg = -1.0;
  vehicle.motor.k2 = kNan;
  vehicle.battery.capacity_ah = 0.0;
  EXPECT_EQ(validate(vehicle).size(), 3U);
}

TEST(Validate, ReportsAnEmptyVehicle) { EXPECT_GT(validate(Vehicle{}).size(), 10U); }

TEST(Validate, AcceptsARotatedInertia) {
  // The triangle inequality is on the principal moments, whatever the axes.
  Vehicle vehicle = kaylion();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::Matrix3d turned = turn * vehicle.inertia * turn.transpose();
  vehicle.inertia = 0.5 * (turned + turned.transpose());
  EXPECT_TRUE(validate(vehicle).empty());
}

TEST(Validate, AcceptsAnOffsetCentreOfMass) {
  Vehicle vehicle = kaylion();
  for (RotorMount& mount : vehicle.rotors) mount.position_frd += Eigen::Vector3d(0.01, -0.005, 0.0);
  EXPECT_TRUE(validate(vehicle).empty());
}

}  // namespace swiftlet::plant::vehicle_test
