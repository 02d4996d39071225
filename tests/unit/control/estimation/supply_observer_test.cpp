#include "swiftlet/control/estimation/supply_observer.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/plant/model/propulsion.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control::supply_observer_test {

constexpr double kStep_s = 0.002;

plant::ActuatorCommand running(double throttle) {
  plant::ActuatorCommand command;
  command.rotor_state = plant::RotorState::kRunning;
  command.rotor_count = 4;
  command.throttle.fill(throttle);
  return command;
}

plant::PerRotor steady_speeds(const plant::Vehicle& vehicle, double supply_v, double throttle) {
  plant::PerRotor speeds{};
  speeds.fill(plant::steady_speed_from_throttle(vehicle, supply_v, throttle));
  return speeds;
}

// GIVEN a measurement at rest WHEN the rotors run THEN the voltage falls by resistance times current: what the battery
// model gives for the power of the motors.
TEST(SupplyObserver, SagsWithTheCurrentOfTheMotors) {
  const plant::Vehicle vehicle = tests::kaylion();
  SupplyObserver observer(vehicle, 4.0);
  for (int i = 0; i < 200; ++i) observer.step(kStep_s, {}, {});
  observer.correct(4.1);
  EXPECT_DOUBLE_EQ(observer.voltage_v(), 4.1);
  const plant::PerRotor speeds = steady_speeds(vehicle, 4.0, 0.4);
  for (int i = 0; i < 200; ++i) observer.step(kStep_s, running(0.4), speeds);
  const double v_s = observer.voltage_v();
  const double v_a = plant::motor_voltage(vehicle.esc, v_s, 0.4);
  const double motor_a = plant::motor_current(plant::motor_dynamics(vehicle), v_a, speeds[0]);
  const double sag_v = vehicle.battery.internal_resistance_ohm * 4.0 * v_a * motor_a / v_s;
  EXPECT_NEAR(4.1 - v_s, sag_v, 1e-6);
  EXPECT_GT(sag_v, 0.05) << "the test shows nothing";
}

TEST(SupplyObserver, AMeasurementIsTheVoltageNow) {
  const plant::Vehicle vehicle = tests::kaylion();
  SupplyObserver observer(vehicle, 4.0);
  for (int i = 0; i < 200; ++i) observer.step(kStep_s, running(0.4), steady_speeds(vehicle, 4.0, 0.4));
  observer.correct(3.8);
  EXPECT_DOUBLE_EQ(observer.voltage_v(), 3.8);
}

}  // namespace swiftlet::control::supply_observer_test
