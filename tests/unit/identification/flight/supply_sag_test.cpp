// Compares the ratio of the supply sag with the simulated vehicle.
#include "swiftlet/identification/flight/supply_sag.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/simulation/dynamics.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::identification::supply_sag_test {

constexpr double kStep = 2e-3;  // of the command

plant::Vehicle vehicle_named(const std::string& name) {
  return io::load_vehicle(tests::in_source("config/vehicles/") + name + ".yaml");
}

// Settled thrust of each rotor, N, at half the charge.
plant::PerRotor settled_thrusts(const plant::Vehicle& vehicle, const plant::PerRotor& commands) {
  const plant::Dynamics dynamics(vehicle, plant::Supply::battery());
  plant::MotorCommand drive;
  drive.state = plant::RotorState::kRunning;
  drive.throttle = commands;
  plant::VehicleState state;
  state.rotor_speeds.fill(1000.0);
  for (int i = 0; i < 3000; ++i) {
    plant::VehicleState next = state;
    next.state_of_charge = 0.5;
    dynamics.advance(next, drive, Eigen::Vector3d::Zero(), 1e-3);
    state.rotor_speeds = next.rotor_speeds;
    state.armature_currents = next.armature_currents;
    state.sag_v = next.sag_v;
  }
  plant::PerRotor out{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(vehicle.rotor_count()); ++i)
    out[i] = vehicle.rotor.thrust * state.rotor_speeds[i] * state.rotor_speeds[i];
  return out;
}

plant::PerRotor all(double command) {
  plant::PerRotor out;
  out.fill(command);
  return out;
}

// Thrust change of rotor 1 when all commands rise, over its change when the first rises and the second falls.
double simulated_ratio(const plant::Vehicle& vehicle) {
  double low = 0.05;
  double high = 1.0;
  for (int i = 0; i < 25; ++i) {
    const double middle = 0.5 * (low + high);
    (settled_thrusts(vehicle, all(middle))[0] < plant::hover_thrust(vehicle) ? low : high) = middle;
  }
  plant::PerRotor differential = all(low);
  differential[0] += kStep;
  differential[1] -= kStep;
  const plant::PerRotor differential_thrusts = settled_thrusts(vehicle, differential);
  const double common_change =
      settled_thrusts(vehicle, all(low + kStep))[0] - settled_thrusts(vehicle, all(low - kStep))[0];
  return common_change / (differential_thrusts[0] - differential_thrusts[1]);
}

TEST(SupplySag, MatchesTheSimulatedVehicle) {
  for (const char* const name : {"kaylion", "crazyflie2"}) {
    const plant::Vehicle vehicle = vehicle_named(name);
    const double ratio = shared_over_single(vehicle);
    std::printf("%s: %.4f\n", name, ratio);
    EXPECT_LT(ratio, 0.97) << name;
    EXPECT_NEAR(ratio, simulated_ratio(vehicle), 0.002) << name;
  }
}

TEST(SupplySag, IsZeroWithoutResistance) {
  plant::Vehicle vehicle = vehicle_named("kaylion");
  vehicle.battery.internal_resistance_ohm = 0.0;
  EXPECT_NEAR(shared_over_single(vehicle), 1.0, 1e-9);
}

}  // namespace swiftlet::identification::supply_sag_test
