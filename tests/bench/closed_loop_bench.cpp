// The mission "square" from take-off to landing: simulated vehicle with all sensors, mocap and flight
// controller in one thread. Plant and inner loop run at 1 kHz.
#include <cstdint>
#include <ctime>
#include <vector>

#include <benchmark/benchmark.h>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/simulated_flight.hpp"

namespace swiftlet {
namespace {

constexpr std::uint64_t kSeed = 1;

// CPU time of this process, s.
double cpu_time_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// The plant of a flight alone, with all its sensors: takes the commands of the flight again, one for each step.
Eigen::Vector3d repeat(const std::vector<plant::MotorCommand>& commands, const plant::Vehicle& vehicle,
                       const plant::SimulationSettings& simulation) {
  plant::PlantSimulation plant(vehicle, simulation, kSeed);
  for (const plant::MotorCommand& command : commands) {
    plant.step(command);
    benchmark::DoNotOptimize(plant.imu().has_value());
  }
  return plant.state().position_ned;
}

// An item is one step of plant and controller: 1 ms. plant_alone: CPU time of the plant's steps alone over that of the
// flight, both measured in turn.
void fly_square(benchmark::State& state, const char* settings_file) {
  const plant::Vehicle vehicle = io::load_vehicle(io::find_config("vehicles/kaylion.yaml"));
  const control::ControlSettings settings = io::load_control_settings(io::find_config(settings_file));
  control::Mission mission =
      io::load_mission_file(io::find_config("missions/square.yaml"), settings.limits).mission;
  plant::SimulationSettings simulation =
      io::load_simulation_settings(io::find_config("simulation/default.yaml"));
  simulation.imu.rate_hz = 1000.0;

  mission.id = 1;
  const double planned_s = io::planned_duration_s(mission, settings.limits);

  std::vector<plant::MotorCommand> commands;
  {
    simulation::ClosedLoop loop(vehicle, simulation, settings, kSeed);
    const auto take_command = [&] { commands.push_back({loop.command.rotor_state, loop.command.throttle}); };
    take_command();
    simulation::fly(loop, mission, planned_s, {nullptr, nullptr, {}, take_command, {}});
    commands.pop_back();  // of the last sample: no step follows
    if (repeat(commands, vehicle, simulation) != loop.plant.state().position_ned)
      return state.SkipWithError("the plant alone moves otherwise than in the flight");
  }
  std::int64_t simulated_ns = 0;
  double flight_s = 0.0;
  double plant_s = 0.0;
  for (auto _ : state) {
    const double begin_s = cpu_time_s();
    simulation::ClosedLoop loop(vehicle, simulation, settings, kSeed);
    const simulation::SimulatedFlight flight = simulation::fly(loop, mission, planned_s, {});
    if (!flight.completed) return state.SkipWithError(flight.reason.c_str());
    simulated_ns += loop.plant.stamp_ns();
    state.PauseTiming();
    flight_s += cpu_time_s() - begin_s;
    const double alone_s = cpu_time_s();
    repeat(commands, vehicle, simulation);
    plant_s += cpu_time_s() - alone_s;
    state.ResumeTiming();
  }
  state.counters["plant_alone"] = plant_s / flight_s;
  state.SetItemsProcessed(simulated_ns / simulation.step_ns);
  state.counters["real_time_factor"] =
      benchmark::Counter(static_cast<double>(simulated_ns) * 1e-9, benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(fly_square, motor_lag, "control/motor_lag.yaml")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fly_square, paper, "control/paper.yaml")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace swiftlet

BENCHMARK_MAIN();
