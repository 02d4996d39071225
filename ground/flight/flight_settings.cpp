#include "swiftlet/ground/flight/flight_settings.hpp"

#include <stdexcept>

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;

void keep(const fs::path& file, const fs::path& copy) {
  std::error_code error;
  fs::copy_file(file, copy, fs::copy_options::overwrite_existing, error);
  if (error) throw std::runtime_error(copy.string() + " cannot be written: " + error.message());
}

}  // namespace

void keep_settings(const LaunchConfiguration& plan) {
  // Under its own ending: it may be of another format.
  keep(plan.mission_file, plan.folder / ("mission" + plan.mission_file.extension().string()));
  if (plan.launch_mode == LaunchMode::kAttached) return;
  keep(plan.control_file, plan.folder / "control.yaml");
  keep(plan.vehicle_file, plan.folder / "vehicle.yaml");
  keep(plan.simulation_file, plan.folder / "simulation.yaml");
}

}  // namespace swiftlet::ground
