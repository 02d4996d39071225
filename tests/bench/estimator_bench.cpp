// The estimator alone: IMU at 1 kHz, poses at 100 Hz with a latency of 10 ms.
#include <vector>

#include <benchmark/benchmark.h>

#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {
namespace {

constexpr std::int64_t kStep_ns = 1'000'000;
constexpr std::int64_t kLatency_ns = 10'000'000;

plant::ImuSample resting(std::int64_t stamp_ns) {
  plant::ImuSample imu;
  imu.stamp_ns = stamp_ns;
  const double wobble = stamp_ns / kStep_ns % 2 == 0 ? 1e-3 : -1e-3;
  imu.specific_force_frd = {wobble, -wobble, -plant::kGravity};
  imu.body_rates_frd = {-wobble, wobble, wobble};
  return imu;
}

plant::PoseSample pose_at(std::int64_t stamp_ns) {
  plant::PoseSample pose;
  pose.stamp_ns = stamp_ns;
  pose.tracked = true;
  pose.position_ned.x() = stamp_ns / (10 * kStep_ns) % 2 == 0 ? 2e-5 : -2e-5;
  return pose;
}

// An item is one IMU sample, with its share of the poses. Argument: IMU samples between poses; 0: no poses.
void estimator_step(benchmark::State& state) {
  const std::int64_t pose_period = state.range(0);
  Estimator estimator{EstimatorSettings{}};
  std::int64_t stamp_ns = kStep_ns;
  estimator.predict(resting(stamp_ns));
  estimator.correct(pose_at(stamp_ns));
  for (; stamp_ns < 1'000'000'000; stamp_ns += kStep_ns) estimator.predict(resting(stamp_ns));
  std::int64_t steps = 0;
  for (auto _ : state) {
    stamp_ns += kStep_ns;
    benchmark::DoNotOptimize(estimator.predict(resting(stamp_ns)));
    if (pose_period > 0 && ++steps % pose_period == 0) {
      benchmark::DoNotOptimize(estimator.correct(pose_at(stamp_ns - kLatency_ns)));
    }
  }
  state.counters["poses_refused"] = static_cast<double>(estimator.estimate().poses_refused);
}
BENCHMARK(estimator_step)->ArgName("imu_samples_a_pose")->Arg(0)->Arg(10)->Arg(1);

void estimate_deviation(benchmark::State& state) {
  Estimator estimator{EstimatorSettings{}};
  std::int64_t stamp_ns = kStep_ns;
  estimator.predict(resting(stamp_ns));
  estimator.correct(pose_at(stamp_ns));
  for (int i = 0; i < 15; ++i) estimator.predict(resting(stamp_ns += kStep_ns));
  for (auto _ : state) benchmark::DoNotOptimize(estimator.standard_deviation());
}
BENCHMARK(estimate_deviation);

}  // namespace
}  // namespace swiftlet::control
