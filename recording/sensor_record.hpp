// What a vehicle sensed and what it was commanded, sample by sample: a flight's record from which it can be
// identified.
#pragma once

#include <cstddef>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/recording/track.hpp"

namespace swiftlet::ground {

struct SensorRecord {
  // capacity: of each track
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
  Track<plant::ActuatorCommand> commands;  // each with the stamp of the IMU sample that it answers
  Track<plant::PoseSample> poses;          // as they came, untracked ones too
  Track<plant::BatterySample> batteries;
  Track<plant::RotorSpeedSample> rotor_speeds;
};

}  // namespace swiftlet::ground
