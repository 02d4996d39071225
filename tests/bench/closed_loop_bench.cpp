// The mission "square" from take-off to landing: simulated vehicle with all sensors, mocap and flight
// controller in one thread. Plant and inner loop run at 1 kHz.
#include <cstdint>

#include <benchmark/benchmark.h>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/simulated_flight.hpp"

namespace swiftlet {
namespace {

// An item is one step of plant and controller: 1 ms.
void fly_square(benchmark::State& state, const char* settings_file) {
  const plant::Vehicle vehicle = runtime::load_vehicle(runtime::find_config("vehicles/kaylion.yaml"));
  const control::ControlSettings settings =
      runtime::load_control_settings(runtime::find_config(settings_file));
  control::Mission mission =
      ground::load_mission_file(runtime::find_config("missions/square.yaml"), settings.limits).mission;
  plant::SimulationSettings simulation =
      runtime::load_simulation_settings(runtime::find_config("simulation/default.yaml"));
  simulation.imu.rate_hz = 1000.0;

  mission.id = 1;
  const double planned_s = ground::planned_duration_s(mission, settings.limits);

  std::int64_t simulated_ns = 0;
  for (auto _ : state) {
    ground::ClosedLoop loop(vehicle, simulation, settings, 1);
    const ground::SimulatedFlight flight = ground::fly(loop, mission, planned_s, {});
    if (!flight.completed) return state.SkipWithError(flight.reason.c_str());
    simulated_ns += loop.plant.stamp_ns();
  }
  state.SetItemsProcessed(simulated_ns / simulation.step_ns);
  state.counters["real_time_factor"] =
      benchmark::Counter(static_cast<double>(simulated_ns) * 1e-9, benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(fly_square, motor_lag, "control/motor_lag.yaml")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fly_square, paper, "control/paper.yaml")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace swiftlet

BENCHMARK_MAIN();
