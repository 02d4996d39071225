#include "swiftlet/ground/flight/flight_description.hpp"

#include <chrono>
#include <filesystem>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "swiftlet/io/text_file.hpp"

namespace swiftlet::ground {
namespace {

std::map<std::string, std::filesystem::path> files_of(const Fleet& fleet) {
  const LaunchConfiguration& first = fleet.plans.front();
  std::map<std::string, std::filesystem::path> files;
  for (std::size_t i = 0; i < fleet.plans.size(); ++i) {
    const std::filesystem::path& mission = fleet.plans[i].mission_file;
    const std::string name = "mission" + mission.extension().string();
    files.emplace(mission == first.mission_file ? name : fleet.vehicles[i] + "/" + name, mission);
  }
  for (std::size_t i = 0; i < fleet.plans.size(); ++i) {
    const std::filesystem::path& vehicle = fleet.plans[i].vehicle_file;
    files.emplace(vehicle == first.vehicle_file ? "vehicle.yaml" : fleet.vehicles[i] + "/vehicle.yaml",
                  vehicle);
  }
  files.emplace("control.yaml", first.control_file);
  if (first.launch_mode != LaunchMode::kAttached) files.emplace("simulation.yaml", first.simulation_file);
  return files;
}

}  // namespace

mcap::WriterSettings writer_settings(const std::string& program) {
  mcap::WriterSettings settings;
  settings.library = program;
  return settings;
}

mcap::Metadata flight_metadata(const Fleet& fleet) {
  const LaunchConfiguration& first = fleet.plans.front();
  std::vector<std::string> missions, models, seeds;
  for (const LaunchConfiguration& plan : fleet.plans) {
    missions.push_back(plan.mission.name);
    models.push_back(plan.vehicle.name);
    seeds.push_back(std::to_string(plan.seed));
  }
  mcap::Metadata metadata{"swiftlet/flight",
                          {{"vehicles", fmt::format("{}", fmt::join(fleet.vehicles, ","))},
                           {"missions", fmt::format("{}", fmt::join(missions, ","))}}};
  metadata.values.insert({{"vehicle", first.vehicle.name},
                          {"models", fmt::format("{}", fmt::join(models, ","))},
                          {"control", first.control.name}});
  if (first.launch_mode == LaunchMode::kAttached) return metadata;  // the running plant has its own settings
  metadata.values.insert({{"simulation", first.simulation_file.stem().string()},
                          {"seed", std::to_string(first.seed)},
                          {"seeds", fmt::format("{}", fmt::join(seeds, ","))},
                          {"clock", report_of(first).clock},
                          {"imu_rate_hz", fmt::format("{:g}", first.simulation.imu.rate_hz)}});
  if (!first.dispersion.name.empty()) metadata.values["dispersion"] = first.dispersion.name;
  return metadata;
}

std::vector<mcap::Attachment> flight_attachments(const Fleet& fleet) {
  const std::int64_t now_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                                  std::chrono::system_clock::now().time_since_epoch())
                                  .count();
  std::vector<mcap::Attachment> attachments;
  for (const auto& [name, file] : files_of(fleet)) {
    const bool yaml = file.extension() == ".yaml";
    attachments.push_back(
        {now_ns, now_ns, name, yaml ? "application/yaml" : "text/plain", io::read_text_file(file)});
  }
  return attachments;
}

}  // namespace swiftlet::ground
