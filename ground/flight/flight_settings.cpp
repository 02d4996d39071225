#include "swiftlet/ground/flight/flight_settings.hpp"

#include <stdexcept>

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;

void copy_to_record(const fs::path& file, const fs::path& copy) {
  std::error_code error;
  fs::copy_file(file, copy, fs::copy_options::overwrite_existing, error);
  if (error) throw std::runtime_error(copy.string() + ": cannot be written: " + error.message());
}

}  // namespace

void keep_settings(const LaunchConfiguration& plan) {
  // Keeps its extension: it may have another format.
  copy_to_record(plan.mission_file, plan.folder / ("mission" + plan.mission_file.extension().string()));
  copy_to_record(plan.control_file, plan.folder / "control.yaml");
  copy_to_record(plan.vehicle_file, plan.folder / "vehicle.yaml");
  if (plan.launch_mode == LaunchMode::kAttached) return;
  copy_to_record(plan.simulation_file, plan.folder / "simulation.yaml");
}

}  // namespace swiftlet::ground
