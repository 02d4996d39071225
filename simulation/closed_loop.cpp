#include "swiftlet/simulation/closed_loop.hpp"

#include <optional>

#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::simulation {

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
      telemetry_path(simulation, seed),
      command_path(simulation, seed),
      pose_path(simulation, seed, plant::streams::kRadioPoses),
      firmware(plant_vehicle, simulation),
      controller(control_vehicle, settings) {
  if (simulation.odometry.source != plant::OdometrySource::kNone) odometry.emplace(simulation, seed);
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
  std::optional<plant::OdometrySample> own;
  if (plant.imu()) firmware.on_imu(*plant.imu());
  if (plant.imu() && odometry) {
    own = odometry->sample(*plant.imu(), plant.state(), firmware.estimator());
    firmware.on_odometry(*own);
  }
  if (plant.battery()) firmware.on_battery(*plant.battery());
  telemetry_path.collect(plant, firmware.obeyed(), own);
}

void ClosedLoop::answer() {
  const std::int64_t now_ns = plant.stamp_ns();
  const plant::VehicleState& truth = plant.state();
  const auto pose = mocap_path.pass(mocap.update(now_ns, truth.position_ned, truth.q_ned_from_frd), now_ns);
  if (pose && mocap_connected) {
    pose_ = pose;
    if (pose_path.on()) {
      pose_path.send(*pose, now_ns);
    } else {
      firmware.on_pose(*pose);
    }
  }
  while (const auto* packet = telemetry_path.take(now_ns)) answer(*packet);
  command = firmware.as_actuators(sent);
}

void ClosedLoop::answer(const plant::TelemetryPacket& packet) {
  if (pose_) controller.on_pose(*pose_);
  if (packet.battery) controller.on_battery(*packet.battery);
  if (packet.rotor_speeds) controller.on_rotor_speeds(*packet.rotor_speeds);
  controller.set_obeyed(packet.obeyed);
  sent = packet.odometry ? controller.on_odometry(*packet.odometry) : controller.on_imu(packet.imu);
  answered = packet.imu;
  answered_odometry = packet.odometry;
  if (sensors != nullptr) record_sensors(packet);
  if (on_answered) on_answered(packet, pose_);
  pose_.reset();
  if (control_connected && command_path.send(sent, plant.stamp_ns())) firmware.accept(sent, plant.stamp_ns());
}

void ClosedLoop::record_sensors(const plant::TelemetryPacket& packet) const {
  sensors->imu.push_back(packet.imu);
  sensors->commands.push_back(firmware.as_actuators(sent));
  if (pose_) sensors->poses.push_back(*pose_);
  if (packet.battery) sensors->batteries.push_back(*packet.battery);
  if (packet.rotor_speeds) sensors->rotor_speeds.push_back(*packet.rotor_speeds);
}

const plant::MotorCommand& ClosedLoop::motor_command() {
  const std::int64_t now_ns = plant.stamp_ns();
  while (const auto* pose = pose_path.take(now_ns)) firmware.on_pose(*pose);
  if (const auto arrived = command_path.arrived(now_ns)) firmware.accept(*arrived, now_ns);
  return firmware.motor_command(now_ns);
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

}  // namespace swiftlet::simulation
