// One integration step of the simulated vehicle in flight: rigid body, four rotors, battery.
#include <benchmark/benchmark.h>

#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::plant {
namespace {

VehicleState hovering() {
  VehicleState state;
  state.position_ned.z() = -1.0;
  state.body_rates_frd = {0.1, -0.2, 0.3};
  for (std::size_t i = 0; i < 4; ++i) state.rotor_speeds[i] = hover_speed(tests::kaylion());
  return state;
}

MotorCommand hover_drive() {
  MotorCommand drive;
  drive.state = RotorState::kRunning;
  drive.throttle = {0.35, 0.36, 0.35, 0.36};
  return drive;
}

void dynamics_step(benchmark::State& state, MotorModel model) {
  Vehicle vehicle = tests::kaylion();
  vehicle.motor.model = model;
  const Dynamics dynamics(vehicle, Supply::battery());
  const MotorCommand drive = hover_drive();
  const Eigen::Vector3d wind = Eigen::Vector3d::Zero();
  VehicleState vehicle_state = hovering();
  for (auto _ : state) {
    dynamics.advance(vehicle_state, drive, wind, 1.0e-3);
    benchmark::DoNotOptimize(vehicle_state);
    vehicle_state.state_of_charge = 0.9;
  }
}
BENCHMARK_CAPTURE(dynamics_step, reduced, MotorModel::kReduced);
BENCHMARK_CAPTURE(dynamics_step, physical, MotorModel::kPhysical);

// With the onboard sensors at their default rates.
void simulation_step(benchmark::State& state) {
  SimulationSettings settings;
  settings.ground.present = false;
  PlantSimulation plant(tests::kaylion(), settings, 1, hovering());
  const MotorCommand drive = hover_drive();
  for (auto _ : state) {
    plant.step(drive);
    benchmark::DoNotOptimize(plant.imu().has_value());
  }
}
BENCHMARK(simulation_step);

}  // namespace
}  // namespace swiftlet::plant

BENCHMARK_MAIN();
