// Plant, motion capture and flight controller in one thread, without DDS. The controller processes each IMU
// sample at its own stamp, after all samples taken before it. The separate processes give bit-identical
// results in lockstep.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "swiftlet/control/flight_controller.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/firmware/firmware.hpp"
#include "swiftlet/plant/simulation/links/command_path.hpp"
#include "swiftlet/plant/simulation/links/mocap_path.hpp"
#include "swiftlet/plant/simulation/links/radio.hpp"
#include "swiftlet/plant/simulation/links/telemetry_path.hpp"
#include "swiftlet/plant/simulation/mocap.hpp"
#include "swiftlet/plant/simulation/odometry.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/record/flight.hpp"

namespace swiftlet::simulation {

class ClosedLoop {
 public:
  // Processes the samples of stamp 0. The vehicle is commanded at the lowest of simulation.control_levels. Throws
  // std::invalid_argument like FlightController.
  ClosedLoop(const plant::Vehicle& vehicle, const plant::SimulationSettings& simulation,
             const control::ControlSettings& settings, std::uint64_t seed);
  // As above, with a controller that is designed for control_vehicle and flies plant_vehicle. Both must have
  // the same number of rotors.
  ClosedLoop(const plant::Vehicle& plant_vehicle, const plant::Vehicle& control_vehicle,
             const plant::SimulationSettings& simulation, const control::ControlSettings& settings,
             std::uint64_t seed);

  // Advances to the next IMU stamp. The controller then processes the IMU samples that have arrived: that of this stamp,
  // unless a fault suppresses it, or over a radio those of before.
  void step();
  // Steps until the predicate is true. Returns false if it is not within limit_s of simulated time.
  bool step_until(const std::function<bool()>& predicate, double limit_s);

  double time_s() const { return static_cast<double>(plant.stamp_ns()) * 1e-9; }
  // Position minus reference, m NED; zero while the rotors are off.
  Eigen::Vector3d tracking_error() const;

  const double imu_rate_hz;
  plant::PlantSimulation plant;
  plant::Mocap mocap;
  plant::MocapPath mocap_path;
  plant::TelemetryPath telemetry_path;
  plant::CommandPath command_path;
  plant::RadioLine<plant::PoseSample> pose_path;  // to the vehicle
  plant::Firmware firmware;
  std::optional<plant::Odometry> odometry;  // of a vehicle that brings it in place of IMU samples
  control::FlightController controller;
  plant::VehicleCommand sent;      // the controller's last command
  plant::ActuatorCommand command;  // the same, as Firmware::as_actuators()
  bool mocap_connected = true;
  bool control_connected = true;             // false: the vehicle receives no commands
  std::optional<plant::ImuSample> answered;  // the last sample that the controller has processed
  std::optional<plant::OdometrySample> answered_odometry;  // that it processed in place of it
  record::Flight* sensors = nullptr;  // takes the controller's inputs and commands; null: they are not kept
  // Called after each sample that the controller has processed, with the pose that came with it; may be empty.
  std::function<void(const plant::TelemetryPacket&, const std::optional<plant::PoseSample>&)> on_answered;

 private:
  void collect();
  void answer();
  void answer(const plant::TelemetryPacket& packet);
  void record_sensors(const plant::TelemetryPacket& packet) const;
  const plant::MotorCommand& motor_command();

  std::optional<plant::PoseSample>
      pose_;  // the newest since the last IMU sample that the controller processed
};

}  // namespace swiftlet::simulation
