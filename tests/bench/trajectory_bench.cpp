// Path planning, and checks of commanded trajectories.
#include <random>

#include <benchmark/benchmark.h>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/planning/feasibility.hpp"
#include "swiftlet/control/planning/waypoint_path.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control {
namespace {

WaypointPath random_path(int points, Smoothness smoothness) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> place(-2.0, 2.0);
  WaypointPath path;
  path.smoothness = smoothness;
  for (int i = 0; i < points; ++i)
    path.points.push_back({{place(generator), place(generator), -1.2 + 0.4 * place(generator)}, 0.0, false});
  return path;
}

// Argument: waypoints. The counter shows the planned duration, s.
void plan_path(benchmark::State& state, Smoothness smoothness) {
  const WaypointPath path = random_path(static_cast<int>(state.range(0)), smoothness);
  double duration_s = 0.0;
  for (auto _ : state) {
    const PlannedPath planned = plan(path);
    benchmark::DoNotOptimize(planned.segments.data());
    duration_s = planned.duration_s;
  }
  state.counters["duration_s"] = duration_s;
  state.SetComplexityN(state.range(0));
}
BENCHMARK_CAPTURE(plan_path, minimum_snap, Smoothness::kMinimumSnap)
    ->Arg(10)
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oN);
BENCHMARK_CAPTURE(plan_path, minimum_jerk, Smoothness::kMinimumJerk)
    ->Arg(10)
    ->Arg(100)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oN);

// A square of 2 m without stops. Argument: half width of the corridors, mm.
void plan_corridor(benchmark::State& state) {
  WaypointPath path;
  for (const auto& corner : {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(2, 0, -1), Eigen::Vector3d(2, 2, -1),
                             Eigen::Vector3d(0, 2, -1), Eigen::Vector3d(0, 0, -1)})
    path.points.push_back({corner, 0.0, false});
  path.legs.assign(4, {LegShape::kCorridor, 1e-3 * static_cast<double>(state.range(0))});
  double duration_s = 0.0;
  for (auto _ : state) {
    const PlannedPath planned = plan(path);
    benchmark::DoNotOptimize(planned.segments.data());
    duration_s = planned.duration_s;
  }
  state.counters["duration_s"] = duration_s;
}
BENCHMARK(plan_corridor)->Arg(300)->Arg(100)->Arg(20)->Unit(benchmark::kMillisecond);

// The spline alone, with given durations. Argument: waypoints.
void solve_spline(benchmark::State& state) {
  const WaypointPath path = random_path(static_cast<int>(state.range(0)), Smoothness::kMinimumSnap);
  std::vector<PositionYaw> places;
  for (const PathPoint& point : path.points)
    places.emplace_back(point.position_ned.x(), point.position_ned.y(), point.position_ned.z(),
                        point.yaw_rad);
  const std::vector<double> durations(places.size() - 1, 1.5);
  for (auto _ : state) benchmark::DoNotOptimize(spline(Smoothness::kMinimumSnap, places, durations).data());
}
BENCHMARK(solve_spline)->Arg(100)->Unit(benchmark::kMicrosecond);

// The check of the control service for a received trajectory. Argument: segments.
void check_trajectory(benchmark::State& state) {
  const Trajectory trajectory{
      1, plan(random_path(static_cast<int>(state.range(0)) + 1, Smoothness::kMinimumSnap)).segments};
  Limits limits;
  limits.fence_min_ned = {-9.0, -9.0, -9.0};  // wide enough that the path is not refused
  limits.fence_max_ned = {9.0, 9.0, 9.0};
  if (!check(trajectory, limits).accepted) state.SkipWithError(check(trajectory, limits).reason);
  for (auto _ : state) benchmark::DoNotOptimize(check(trajectory, limits).accepted);
}
BENCHMARK(check_trajectory)->Arg(100)->Arg(1024)->Unit(benchmark::kMicrosecond);

// Argument: segments.
void survey_demands(benchmark::State& state) {
  const auto segments =
      plan(random_path(static_cast<int>(state.range(0)) + 1, Smoothness::kMinimumSnap)).segments;
  for (auto _ : state)
    benchmark::DoNotOptimize(worst_demands(tests::kaylion(), Limits(), 3.7, segments).data());
}
BENCHMARK(survey_demands)->Arg(100)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace swiftlet::control

BENCHMARK_MAIN();
