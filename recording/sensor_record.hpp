// Record of a vehicle's sensor samples and actuator commands, from which the vehicle can be identified.
#pragma once

#include <cstddef>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/recording/track.hpp"

namespace swiftlet::ground {

struct SensorRecord {
  // capacity: rows of each track
  explicit SensorRecord(std::size_t capacity)
      : imu(capacity), commands(capacity), poses(capacity), batteries(capacity), rotor_speeds(capacity) {}

  void clear() noexcept {
    imu.clear();
    commands.clear();
    poses.clear();
    batteries.clear();
    rotor_speeds.clear();
  }

  Track<plant::ImuSample> imu;
  Track<plant::ActuatorCommand> commands;  // stamp: that of the IMU sample the command was computed from
  Track<plant::PoseSample> poses;          // in order of arrival, untracked frames included
  Track<plant::BatterySample> batteries;
  Track<plant::RotorSpeedSample> rotor_speeds;
};

}  // namespace swiftlet::ground
