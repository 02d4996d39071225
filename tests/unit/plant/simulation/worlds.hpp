// Simulation settings and motor commands that the tests of plant/simulation share.
#pragma once

#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/plant/simulation/vehicle_state.hpp"

namespace swiftlet::tests {

// No noise, no bias, no drag, a supply of constant voltage, no floor.
inline plant::SimulationSettings empty_space() {
  plant::SimulationSettings settings;
  settings.imu.accelerometer_noise_density = 0.0;
  settings.imu.gyro_noise_density = 0.0;
  settings.imu.accelerometer_bias_sigma = 0.0;
  settings.imu.gyro_bias_sigma = 0.0;
  settings.imu.accelerometer_bias_walk = 0.0;
  settings.imu.gyro_bias_walk = 0.0;
  settings.imu.accelerometer_range = 1.0e3;
  settings.imu.gyro_range = 1.0e3;
  settings.supply.ideal = true;
  settings.air.drag = false;
  settings.ground.present = false;
  return settings;
}

inline plant::MotorCommand running(double throttle) {
  plant::MotorCommand command;
  command.state = plant::RotorState::kRunning;
  command.throttle.fill(throttle);
  return command;
}

}  // namespace swiftlet::tests
