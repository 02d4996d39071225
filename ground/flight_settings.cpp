#include "swiftlet/ground/flight_settings.hpp"

#include <array>
#include <stdexcept>

#include "swiftlet/services/runtime/flat_yaml.hpp"
#include "swiftlet/services/runtime/text_file.hpp"

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;

constexpr std::array kKinds = {"control", "mission", "simulation", "vehicle"};

void keep(const fs::path& file, const fs::path& copy) {
  std::error_code error;
  fs::copy_file(file, copy, fs::copy_options::overwrite_existing, error);
  if (error) throw std::runtime_error(copy.string() + " cannot be written: " + error.message());
}

}  // namespace

void keep_settings(const FlightPlan& plan) {
  // Under its own ending: it may be of another format.
  keep(plan.mission_file, plan.folder / ("mission" + plan.mission_file.extension().string()));
  if (plan.parties == Parties::kAttached) return;
  keep(plan.control_file, plan.folder / "control.yaml");
  keep(plan.vehicle_file, plan.folder / "vehicle.yaml");
  keep(plan.simulation_file, plan.folder / "simulation.yaml");
}

std::vector<std::pair<std::string, std::string>> kept_settings(const fs::path& folder) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const std::string kind : kKinds) {
    const fs::path file = folder / (kind + ".yaml");
    if (!fs::exists(file)) continue;
    for (auto& [key, value] : runtime::flatten_yaml(runtime::read_text_file(file.string()), file.string()))
      all.emplace_back(kind + "." + key, std::move(value));
  }
  return all;
}

}  // namespace swiftlet::ground
