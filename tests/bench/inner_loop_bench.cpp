// One step of the whole inner loop in flight: estimate, supervision, position, attitude, allocation.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <benchmark/benchmark.h>

#include "swiftlet/control/flight_controller.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/closed_loop.hpp"

namespace swiftlet {
namespace {

control::Request request(control::RequestKind kind,
                         const Eigen::Vector3d& position_ned = Eigen::Vector3d::Zero()) {
  control::Request request;
  request.kind = kind;
  request.position_ned = position_ned;
  return request;
}

// A closed loop after take-off, on a long and slow minimum-jerk line.
simulation::ClosedLoop loop_in_flight(const char* settings) {
  simulation::ClosedLoop loop(io::load_vehicle(io::find_config("vehicles/kaylion.yaml")),
                              plant::SimulationSettings(),
                              io::load_control_settings(io::find_config(settings)), 1);
  loop.step_until([&] { return loop.time_s() > 0.5; }, 1.0);
  if (!loop.controller.request(request(control::RequestKind::kArm)).accepted ||
      !loop.controller.request(request(control::RequestKind::kTakeoff, {0, 0, -1})).accepted ||
      !loop.step_until([&] { return loop.controller.status().mode == control::Mode::kHolding; }, 10.0)) {
    throw std::runtime_error("did not take off");
  }
  control::Request move = request(control::RequestKind::kGoTo, {2, 2, -1.5});
  move.speed = 1e-3;
  if (!loop.controller.request(move).accepted) throw std::runtime_error("did not move");
  return loop;
}

// Repeats samples of steady flight with new stamps: a pose with every fifth IMU sample, the battery at 10 Hz.
// Times the controller as in flight, without the plant.
void inner_loop_step(benchmark::State& state, const char* settings) {
  simulation::ClosedLoop loop = loop_in_flight(settings);
  constexpr int kPosePeriod = 5;
  constexpr int kBatteryPeriod = 50;
  plant::ImuSample imu = *loop.plant.imu();
  imu.specific_force_frd = {0.0, 0.0, -plant::kGravity};
  imu.body_rates_frd.setZero();
  plant::PoseSample pose;
  pose.tracked = true;
  pose.position_ned = loop.controller.estimate().position_ned;
  pose.sequence = 1'000'000;
  plant::BatterySample battery;
  battery.voltage_v = loop.controller.status().supply_voltage_v;
  for (auto _ : state) {
    imu.stamp_ns += 2'000'000;
    ++imu.sequence;
    if (imu.sequence % kPosePeriod == 0) {
      pose.stamp_ns = imu.stamp_ns - 10'000'000;
      ++pose.sequence;
      pose.position_ned.x() +=
          pose.sequence % 2 == 0 ? 2e-5 : -2e-5;  // noise, since an equal pose counts as stuck
      loop.controller.on_pose(pose);
    }
    if (imu.sequence % kBatteryPeriod == 0) {
      battery.stamp_ns = imu.stamp_ns;
      loop.controller.on_battery(battery);
    }
    auto command = loop.controller.on_imu(imu);
    benchmark::DoNotOptimize(command);
  }
  if (loop.controller.status().mode != control::Mode::kHolding) state.SkipWithError("left the flight");
}
BENCHMARK_CAPTURE(inner_loop_step, motor_lag, "control/motor_lag.yaml");
BENCHMARK_CAPTURE(inner_loop_step, paper, "control/paper.yaml");

}  // namespace
}  // namespace swiftlet

BENCHMARK_MAIN();
