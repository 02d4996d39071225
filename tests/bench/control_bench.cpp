// The parts of one control step, and the gain design that runs once at start.
#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "swiftlet/control/allocation/allocator.hpp"
#include "swiftlet/control/attitude/attitude_controller.hpp"
#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/position/position_controller.hpp"
#include "swiftlet/control/position/thrust_attitude_map.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/math/euler.hpp"
#include "tests/support/paths.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Vector3d;

const ControlSettings& settings() {
  static const ControlSettings loaded =
      io::load_control_settings(tests::in_source("config/control/motor_lag.yaml"));
  return loaded;
}

// Random wrenches, so that branch prediction does not learn them. `size` scales the moments and the deviation
// of thrust from hover.
std::vector<Wrench> wrenches(const plant::Vehicle& vehicle, double size) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> draw(-size, size);
  std::vector<Wrench> out(1024);
  for (Wrench& w : out) {
    w.thrust_n = vehicle.mass_kg * plant::kGravity * (1.0 + draw(generator));
    w.moment_frd = {0.03 * draw(generator), 0.03 * draw(generator), 0.003 * draw(generator)};
  }
  return out;
}

// Arguments: rotors; size of the wrenches in percent. Counts the share of saturated allocations.
void allocate(benchmark::State& state) {
  const int rotors = static_cast<int>(state.range(0));
  const plant::Vehicle vehicle = rotors == 4 ? tests::kaylion() : tests::multirotor(rotors);
  const Allocator allocator(vehicle);
  const Allocator::Supply supply = allocator.supply_at(3.8);
  const std::vector<Wrench> wanted = wrenches(vehicle, 0.01 * static_cast<double>(state.range(1)));
  std::size_t i = 0;
  std::size_t saturated = 0;
  for (auto _ : state) {
    Allocation out = allocator.allocate(wanted[i++ % wanted.size()], supply);
    saturated += out.saturated ? 1 : 0;
    benchmark::DoNotOptimize(out);
  }
  state.counters["saturated"] = static_cast<double>(saturated) / static_cast<double>(state.iterations());
}
BENCHMARK(allocate)->ArgNames({"rotors", "percent"})->ArgsProduct({{4, 6, 8}, {5, 100, 300}});

void attitude_moments(benchmark::State& state, AttitudeErrorKind error) {
  const plant::Vehicle& vehicle = tests::kaylion();
  AttitudeSettings attitude = settings().attitude;
  attitude.error = error;
  const AttitudeController controller(vehicle, attitude, design(vehicle, settings()));
  AttitudeReference reference;
  reference.body_z_ned = math::quaternion_from_euler({0.1, -0.05, 0.3}) * Vector3d::UnitZ();
  reference.heading = 0.3;
  Eigen::Quaterniond q = math::quaternion_from_euler({0.12, -0.04, 0.31});
  Vector3d rates(0.2, -0.3, 0.1);
  Vector3d moment(1e-4, -2e-4, 1e-5);
  for (auto _ : state) {
    benchmark::DoNotOptimize(q.coeffs().data());
    benchmark::ClobberMemory();
    benchmark::DoNotOptimize(controller.moments(q, rates, moment, reference));
  }
}
BENCHMARK_CAPTURE(attitude_moments, math::euler_angles, AttitudeErrorKind::kEulerAngles);
BENCHMARK_CAPTURE(attitude_moments, rotation, AttitudeErrorKind::kRotation);

// Reference from the polynomial, position law, conversion to thrust and attitude, feedforward.
void outer_loop(benchmark::State& state) {
  const plant::Vehicle& vehicle = tests::kaylion();
  PositionController controller(settings().position, settings().limits, design(vehicle, settings()));
  const PolynomialSegment segment = minimum_jerk({0, 0, -1}, 0.0, {2, 1, -1.5}, 0.5, 8.0);
  Vector3d position(0.0, 0.0, -1.0);
  double t = 0.0;
  for (auto _ : state) {
    t = t < 8.0 ? t + 0.002 : 0.0;
    const Reference reference = evaluate(segment, t);
    const PositionCommand command = controller.step(position, Vector3d::Zero(), reference, 0.002, false);
    benchmark::DoNotOptimize(thrust_attitude(vehicle.mass_kg, command.acceleration_ned, 0.7));
    benchmark::DoNotOptimize(reference_motion(vehicle.mass_kg, reference, reference.yaw_rad));
  }
}
BENCHMARK(outer_loop);

void design_all_gains(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(design(tests::kaylion(), settings()));
}
BENCHMARK(design_all_gains)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace swiftlet::control

BENCHMARK_MAIN();
