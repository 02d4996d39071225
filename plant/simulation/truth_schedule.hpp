// When the ground truth is published: for motion capture and telemetry, which do not need that of every IMU sample.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/plant/simulation/mocap_schedule.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

class TruthSchedule {
 public:
  explicit TruthSchedule(const SimulationSettings& settings);

  // Call it once at each stamp.
  bool due(const PlantSimulation& simulation);

 private:
  std::int64_t imu_period_ns_;
  // Without a value the truth of every sample is needed: the frames cannot be foreseen.
  std::optional<MocapSchedule> mocap_;
};

}  // namespace swiftlet::plant
