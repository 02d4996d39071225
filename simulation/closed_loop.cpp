#include "swiftlet/simulation/closed_loop.hpp"

#include <optional>

namespace swiftlet::ground {

ClosedLoop::ClosedLoop(const plant::Vehicle& vehicle, const plant::SimulationSettings& simulation,
                       const control::ControlSettings& settings, std::uint64_t seed)
    : ClosedLoop(vehicle, vehicle, simulation, settings, seed) {}

ClosedLoop::ClosedLoop(const plant::Vehicle& plant_vehicle, const plant::Vehicle& control_vehicle,
                       const plant::SimulationSettings& simulation, const control::ControlSettings& settings,
                       std::uint64_t seed)
    : imu_rate_hz(simulation.imu.rate_hz),
      plant(plant_vehicle, simulation, seed),
      mocap(simulation.mocap, seed),
      mocap_path(simulation, seed),
      command_path(simulation),
      firmware(plant_vehicle, simulation),
      controller(control_vehicle, settings) {
  controller.set_levels(simulation.control_levels, std::nullopt);
  collect();
  answer();
}

void ClosedLoop::step() {
  do {
    plant.step(motor_command());
    collect();
  } while (!plant.imu_due());
  answer();
}

void ClosedLoop::collect() {
  if (plant.imu()) firmware.on_imu(*plant.imu());
  if (plant.battery()) {
    battery_ = plant.battery();
    firmware.on_battery(*battery_);
  }
  if (plant.rotor_speeds()) rotor_speeds_ = plant.rotor_speeds();
}

void ClosedLoop::answer() {
  const plant::VehicleState& truth = plant.state();
  const auto pose = mocap_path.pass(mocap.update(plant.stamp_ns(), truth.position_ned, truth.q_ned_from_frd),
                                    plant.stamp_ns());
  if (pose && mocap_connected) {
    pose_ = pose;
    firmware.on_pose(*pose);
  }
  if (!plant.imu()) return;
  if (pose_) controller.on_pose(*pose_);
  if (battery_) controller.on_battery(*battery_);
  if (rotor_speeds_) controller.on_rotor_speeds(*rotor_speeds_);
  sent = controller.on_imu(*plant.imu());
  command = firmware.as_actuators(sent);
  if (sensors != nullptr) record_sensors();
  pose_.reset();
  battery_.reset();
  rotor_speeds_.reset();
  if (control_connected && command_path.send(sent, plant.stamp_ns())) firmware.accept(sent, plant.stamp_ns());
}

void ClosedLoop::record_sensors() const {
  sensors->imu.append(*plant.imu());
  sensors->commands.append(command);
  if (pose_) sensors->poses.append(*pose_);
  if (battery_) sensors->batteries.append(*battery_);
  if (rotor_speeds_) sensors->rotor_speeds.append(*rotor_speeds_);
}

const plant::MotorCommand& ClosedLoop::motor_command() {
  if (const auto arrived = command_path.arrived(plant.stamp_ns()))
    firmware.accept(*arrived, plant.stamp_ns());
  return firmware.motor_command(plant.stamp_ns());
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

}  // namespace swiftlet::ground
