#include "swiftlet/ground/flight/message_record.hpp"

#include <chrono>
#include <map>

#include <fmt/format.h>

#include "swiftlet/io/logs/flight_log_files.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/runtime/clock.hpp"

namespace swiftlet::ground {
namespace {

RecorderSettings settings_of(const Fleet& fleet) {
  RecorderSettings settings;
  settings.file.library = fleet.program;
  if (fleet.plans.front().clock == runtime::Clock::kLockstep) settings.clock = RecordClock::kVehicle;
  return settings;
}

mcap::Metadata metadata_of(const Fleet& fleet) {
  const LaunchConfiguration& first = fleet.plans.front();
  std::vector<std::string> missions;
  for (const LaunchConfiguration& plan : fleet.plans) missions.push_back(plan.mission.name);
  mcap::Metadata metadata{"swiftlet/flight",
                          {{"vehicles", fmt::format("{}", fmt::join(fleet.vehicles, ","))},
                           {"missions", fmt::format("{}", fmt::join(missions, ","))}}};
  if (first.launch_mode == LaunchMode::kAttached) return metadata;  // the running processes have their own
  metadata.values.insert({{"vehicle", first.vehicle.name},
                          {"control", first.control.name},
                          {"simulation", first.simulation_file.stem().string()},
                          {"seed", std::to_string(first.seed)},
                          {"clock", runtime::to_string(first.clock)},
                          {"imu_rate_hz", fmt::format("{:g}", first.simulation.imu.rate_hz)}});
  return metadata;
}

// The files of a flight by the names that they have in its record: vehicle.yaml and so on. Missions that differ are
// called kl2/mission.yaml.
std::map<std::string, std::filesystem::path> files_of(const Fleet& fleet) {
  const LaunchConfiguration& first = fleet.plans.front();
  std::map<std::string, std::filesystem::path> files;
  for (std::size_t i = 0; i < fleet.plans.size(); ++i) {
    const std::filesystem::path& mission = fleet.plans[i].mission_file;
    const std::string name = "mission" + mission.extension().string();
    files.emplace(mission == first.mission_file ? name : fleet.vehicles[i] + "/" + name, mission);
  }
  if (first.launch_mode == LaunchMode::kAttached) return files;  // the running processes have their own
  files.insert({{"vehicle.yaml", first.vehicle_file},
                {"control.yaml", first.control_file},
                {"simulation.yaml", first.simulation_file}});
  return files;
}

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

comms::NodeSettings listener(comms::NodeSettings network) {
  network.source_of.clear();
  return network;
}

}  // namespace

MessageRecord::MessageRecord(const comms::NodeSettings& network, const Fleet& fleet)
    : participant_(listener(network)),
      recorder_(participant_, fleet.folder / kMessagesFile, settings_of(fleet)) {
  recorder_.add(metadata_of(fleet));
  for (const auto& [name, file] : files_of(fleet)) {
    const std::int64_t now = now_ns();
    const bool yaml = file.extension() == ".yaml";
    recorder_.add(mcap::Attachment{now, now, name, yaml ? "application/yaml" : "text/plain",
                                   runtime::read_text_file(file)});
  }
  for (const std::string& vehicle : fleet.vehicles) recorder_.add_vehicle(vehicle);
}

std::string MessageRecord::finish() {
  recorder_.stop();
  if (const auto fault = recorder_.fault()) return *fault;
  const RecorderTotals totals = recorder_.totals();
  if (totals.dropped + totals.lost == 0) return {};
  return fmt::format("{}: {} messages dropped because the disk is too slow, {} lost on their way",
                     kMessagesFile, totals.dropped, totals.lost);
}

}  // namespace swiftlet::ground
