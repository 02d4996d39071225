#include "tests/support/closed_loop.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::test {

ClosedLoop::ClosedLoop(const plant::Vehicle& vehicle, const plant::SimulationSettings& simulation,
                       const control::ControlSettings& settings, std::uint64_t seed)
    : plant(vehicle, simulation, seed),
      mocap(simulation.mocap, seed),
      watchdog(vehicle.rotor_count(), std::llround(simulation.command_timeout_s * 1e9)),
      controller(vehicle, settings) {}

void ClosedLoop::step() {
  do {
    plant.step(watchdog.drive(plant.stamp_ns()));
  } while (!plant.imu());
  const auto pose = mocap.update(plant.truth());
  if (pose && mocap_connected) controller.on_pose(*pose);
  if (plant.battery()) controller.on_battery(*plant.battery());
  if (plant.rotor_speeds()) controller.on_rotor_speeds(*plant.rotor_speeds());
  command = controller.on_imu(*plant.imu());
  watchdog.accept(command, plant.stamp_ns());
}

bool ClosedLoop::step_until(const std::function<bool()>& predicate, double limit_s) {
  const double end = time_s() + limit_s;
  while (!predicate()) {
    if (time_s() > end) return false;
    step();
  }
  return true;
}

Eigen::Vector3d ClosedLoop::tracking_error() const {
  if (command.rotor_state == plant::RotorState::kOff) return Eigen::Vector3d::Zero();
  return plant.state().position_ned - controller.reference().position_ned;
}

MissionResult fly(ClosedLoop& loop, const control::Mission& mission) {
  MissionResult result;
  const auto& status = loop.controller.status();
  const auto ask = [&](const control::Request& request) {
    const control::Outcome outcome = loop.controller.request(request);
    if (!outcome.accepted) result.reason = outcome.reason;
    return outcome.accepted;
  };
  loop.step_until([&] { return loop.time_s() > 1.0 && status.has_pose; }, 3.0);
  control::Request arm;
  arm.kind = control::RequestKind::kArm;
  control::Request start;
  start.kind = control::RequestKind::kMission;
  start.mission = &mission;
  if (!ask(arm) || !ask(start)) return result;

  const bool lands = mission.items.back().kind == control::MissionItemKind::kLand;
  const double start_s = loop.time_s();
  double square_sum = 0.0;
  std::size_t samples = 0;
  while (status.mission.state != control::MissionState::kCompleted) {
    loop.step();
    if (status.mission.state == control::MissionState::kAborted || loop.time_s() - start_s > 600.0) {
      result.reason = status.reason;
      return result;
    }
    if (lands && status.mission.item_index + 1 == status.mission.item_count) continue;
    const double error = loop.tracking_error().norm();
    square_sum += error * error;
    result.peak_3d_m = std::max(result.peak_3d_m, error);
    result.duration_s = loop.time_s() - start_s;
    ++samples;
  }
  result.completed = true;
  result.rms_3d_m = std::sqrt(square_sum / static_cast<double>(samples));
  return result;
}

}  // namespace swiftlet::test
