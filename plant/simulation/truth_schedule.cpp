#include "swiftlet/plant/simulation/truth_schedule.hpp"

#include "swiftlet/plant/model/telemetry_rate.hpp"

namespace swiftlet::plant {
namespace {

// Irregular intervals depend on the seed of motion capture, and faults may delay frames.
std::optional<MocapSchedule> foreseen_frames(const SimulationSettings& settings) {
  if (settings.mocap.model == MocapModel::kOptitrack || !settings.faults.empty()) return std::nullopt;
  return MocapSchedule(settings.mocap, 0);
}

}  // namespace

TruthSchedule::TruthSchedule(const SimulationSettings& settings)
    : imu_period_ns_(period_ns(settings.imu.rate_hz)), mocap_(foreseen_frames(settings)) {}

bool TruthSchedule::due(const PlantSimulation& simulation) {
  if (!simulation.imu_due()) return false;
  if (!mocap_) return true;
  const MocapSchedule::Events frame = mocap_->advance(simulation.stamp_ns());
  return frame.exposes || frame.delivers || is_telemetry_sample(simulation.imu_count(), imu_period_ns_);
}

}  // namespace swiftlet::plant
