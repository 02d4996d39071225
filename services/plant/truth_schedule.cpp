#include "swiftlet/services/plant/truth_schedule.hpp"

#include "swiftlet/recording/telemetry_rate.hpp"

namespace swiftlet::services {
namespace {

// Irregular intervals depend on the seed of motion capture, and faults may delay frames.
std::optional<plant::MocapSchedule> foreseen_frames(const plant::SimulationSettings& settings) {
  if (settings.mocap.model == plant::MocapModel::kOptitrack || !settings.faults.empty()) return std::nullopt;
  return plant::MocapSchedule(settings.mocap, 0);
}

}  // namespace

TruthSchedule::TruthSchedule(const plant::SimulationSettings& settings)
    : imu_period_ns_(plant::period_ns(settings.imu.rate_hz)), mocap_(foreseen_frames(settings)) {}

bool TruthSchedule::due(const plant::PlantSimulation& simulation) {
  if (!simulation.imu_due()) return false;
  if (!mocap_) return true;
  const plant::MocapSchedule::Events frame = mocap_->advance(simulation.stamp_ns());
  return frame.exposes || frame.delivers ||
         runtime::is_telemetry_sample(simulation.imu_count(), imu_period_ns_);
}

}  // namespace swiftlet::services
