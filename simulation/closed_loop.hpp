// Plant, mocap and flight controller in one thread, without DDS: each IMU sample is answered at its own
// stamp, after the samples that were taken before it. The separate processes do the same in lockstep, to the
// last bit.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "swiftlet/control/flight_controller.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/actuator_watchdog.hpp"
#include "swiftlet/plant/simulation/links/command_path.hpp"
#include "swiftlet/plant/simulation/links/mocap_path.hpp"
#include "swiftlet/plant/simulation/mocap.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/recording/sensor_record.hpp"

namespace swiftlet::ground {

class ClosedLoop {
 public:
  // Answers the samples of stamp 0. Throws std::invalid_argument as FlightController does.
  ClosedLoop(const plant::Vehicle& vehicle, const plant::SimulationSettings& simulation,
             const control::ControlSettings& settings, std::uint64_t seed);
  // A controller that was designed on another vehicle than the one that flies. Both have as many rotors.
  ClosedLoop(const plant::Vehicle& plant_vehicle, const plant::Vehicle& control_vehicle,
             const plant::SimulationSettings& simulation, const control::ControlSettings& settings,
             std::uint64_t seed);

  // Up to the next stamp of the IMU, and the controller's answer to its sample if a fault does not keep it
  // back.
  void step();
  // Steps until the predicate holds; false if it does not within limit_s of simulated time.
  bool step_until(const std::function<bool()>& predicate, double limit_s);

  double time_s() const { return static_cast<double>(plant.stamp_ns()) * 1e-9; }
  // Position less reference, m NED; zero while the rotors are off.
  Eigen::Vector3d tracking_error() const;

  const double imu_rate_hz;
  plant::PlantSimulation plant;
  plant::Mocap mocap;
  plant::MocapPath mocap_path;
  plant::CommandPath command_path;
  plant::ActuatorWatchdog watchdog;
  control::FlightController controller;
  plant::ActuatorCommand command;  // the last answer
  bool mocap_connected = true;
  SensorRecord* sensors = nullptr;  // where all that the controller gets and answers is kept; may be null

 private:
  void collect();
  void answer();
  void keep_sensors() const;
  const plant::MotorCommand& drive();

  // The newest since the last answer.
  std::optional<plant::PoseSample> pose_;
  std::optional<plant::BatterySample> battery_;
  std::optional<plant::RotorSpeedSample> rotor_speeds_;
};

}  // namespace swiftlet::ground
